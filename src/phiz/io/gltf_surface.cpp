// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/io/gltf_surface.h"

#include <map>

#include "phiz/geometry/surface.h"

namespace phiz {

MatrixX3d shading_normals(const MatrixX3d& V, const MatrixX3i& F) {
  MatrixX3d normals = vertex_normals(V, F);
  for (Eigen::Index i = 0; i < normals.rows(); ++i) {
    if (!(normals.row(i).squaredNorm() > 0.5)) normals.row(i) = Eigen::RowVector3d::UnitZ();
  }
  return normals;
}

GltfSurface::GltfSurface(const TriangleMesh& mesh) : F_(mesh.F), triangles_(mesh.F.rows(), 3) {
  const bool with_uv = mesh.FUV.rows() == mesh.F.rows() && mesh.UV.rows() > 0;
  std::map<std::pair<int, int>, int> rows;
  std::vector<int> uv_rows;
  for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
    for (int c = 0; c < 3; ++c) {
      const std::pair<int, int> corner(mesh.F(f, c), with_uv ? mesh.FUV(f, c) : 0);
      const auto [place, added] = rows.try_emplace(corner, static_cast<int>(source_.size()));
      if (added) {
        source_.push_back(corner.first);
        uv_rows.push_back(corner.second);
      }
      triangles_(f, c) = place->second;
    }
  }
  if (!with_uv) return;
  texels_.resize(static_cast<Eigen::Index>(uv_rows.size()), 2);
  for (std::size_t i = 0; i < uv_rows.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    texels_.row(row) << static_cast<float>(mesh.UV(uv_rows[i], 0)), static_cast<float>(1 - mesh.UV(uv_rows[i], 1));
  }
}

GltfVectors GltfSurface::spread(const MatrixX3d& values) const {
  GltfVectors result(static_cast<Eigen::Index>(source_.size()), 3);
  for (std::size_t i = 0; i < source_.size(); ++i) {
    result.row(static_cast<Eigen::Index>(i)) = values.row(source_[i]).cast<float>();
  }
  return result;
}

GltfPrimitive GltfSurface::primitive(const MatrixX3d& V, int material) const {
  GltfPrimitive result;
  result.positions = spread(V);
  result.normals = spread(shading_normals(V, F_));
  result.normals.rowwise().normalize();
  result.texels = texels_;
  result.triangles = triangles_;
  result.material = material;
  return result;
}

}  // namespace phiz
