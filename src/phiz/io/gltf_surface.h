// SPDX-License-Identifier: GPL-3.0-or-later
/// A triangle mesh in the form that glTF wants: one vertex per pair of position and texture coordinate.
#pragma once

#include <vector>

#include "phiz/io/gltf.h"

namespace phiz {

class GltfSurface {
 public:
  /// Vertices at seams of the texture coordinates are doubled; v is turned downward.
  explicit GltfSurface(const TriangleMesh& mesh);

  /// The surface with other positions of the same vertices (rows as in the mesh), smooth normals and texture
  /// coordinates.
  GltfPrimitive primitive(const MatrixX3d& V, int material) const;
  /// Rows of values per mesh vertex, brought to the doubled vertices.
  GltfVectors spread(const MatrixX3d& values) const;
  const GltfTriangles& triangles() const { return triangles_; }

 private:
  MatrixX3i F_;
  std::vector<int> source_;  ///< mesh vertex per glTF vertex
  GltfTexels texels_;
  GltfTriangles triangles_;
};

/// Unit vertex normals; +z where a vertex has no area around it (glTF allows no zero normals).
MatrixX3d shading_normals(const MatrixX3d& V, const MatrixX3i& F);

}  // namespace phiz
