// SPDX-License-Identifier: GPL-3.0-or-later
/// Catmull-Clark subdivision as matrices (OpenSubdiv behind the scenes).
#pragma once

#include <vector>

#include "phiz/geometry/mesh.h"

namespace phiz {

struct Subdivision {
  SparseMatrixd points;  ///< vertices of the finer mesh from those of the cage; rows sum to 1
  SparseMatrixd limit;   ///< the same vertices pushed to the limit surface; rows sum to 1
  std::vector<std::vector<int>> faces;
  MatrixX2d UV;
  std::vector<std::vector<int>> face_uvs;
};

/// `level` uniform subdivisions of a closed polygon mesh. Vertex i of the cage is vertex i of the result.
Subdivision subdivide(const PolygonMesh& cage, int level);

/// The vertices of the subdivided mesh along a path of cage edges.
std::vector<int> subdivide_path(const PolygonMesh& cage, int level, std::vector<int> path);

}  // namespace phiz
