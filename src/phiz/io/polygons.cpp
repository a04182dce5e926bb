// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/io/polygons.h"

namespace phiz {

PolygonMesh as_polygons(const TriangleMesh& mesh) {
  PolygonMesh result;
  result.V = mesh.V;
  const auto faces = [](const MatrixX3i& F) {
    std::vector<std::vector<int>> list;
    list.reserve(static_cast<std::size_t>(F.rows()));
    for (Eigen::Index f = 0; f < F.rows(); ++f) list.push_back({F(f, 0), F(f, 1), F(f, 2)});
    return list;
  };
  result.faces = faces(mesh.F);
  if (mesh.FUV.rows() > 0) {
    result.UV = mesh.UV;
    result.face_uvs = faces(mesh.FUV);
  }
  return result;
}

}  // namespace phiz
