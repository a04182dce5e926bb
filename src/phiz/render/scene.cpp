// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/render/scene.h"

#include <fmt/format.h>

#include "phiz/core/error.h"

namespace phiz {

Eigen::AlignedBox3d bounding_box(const Scene& scene) {
  Eigen::AlignedBox3d box;
  for (const Surface& s : scene.surfaces)
    for (Eigen::Index i = 0; i < s.mesh.V.rows(); ++i) box.extend(s.transform * Vector3d(s.mesh.V.row(i)));
  return box;
}

MatrixX3d world_points(const Scene& scene) {
  Eigen::Index count = 0;
  for (const Surface& s : scene.surfaces) count += s.mesh.V.rows();
  MatrixX3d points(count, 3);
  Eigen::Index row = 0;
  for (const Surface& s : scene.surfaces) {
    points.middleRows(row, s.mesh.V.rows()) =
        (s.mesh.V * s.transform.linear().transpose()).rowwise() + s.transform.translation().transpose();
    row += s.mesh.V.rows();
  }
  return points;
}

void validate(const Scene& scene) {
  for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
    const Surface& s = scene.surfaces[i];
    const std::string where = fmt::format("scene, surface {} '{}'", i, s.name);
    const Eigen::Index n = s.mesh.V.rows();
    if (!s.mesh.V.allFinite() || !s.transform.matrix().allFinite())
      reject(where, "a vertex position or the transform is not finite", "repair the mesh before rendering it");
    if (s.mesh.F.rows() > 0 && (s.mesh.F.minCoeff() < 0 || s.mesh.F.maxCoeff() >= n))
      reject(where, fmt::format("a triangle names a vertex outside 0 .. {}", n - 1), "repair the mesh");
    const auto check = [&](const MatrixX3d& values, const char* what) {
      if (values.rows() != 0 && values.rows() != n)
        reject(where, fmt::format("{} has {} rows for {} vertices", what, values.rows(), n), "give one row per vertex");
      if (!values.allFinite()) reject(where, fmt::format("{} holds a value that is not finite", what));
    };
    check(s.normals, "normals");
    check(s.colour, "colour");
    check(s.rest, "rest");
    check(s.fibre, "fibre");
    if (!s.wireframe.edges.empty() && static_cast<Eigen::Index>(s.wireframe.edges.size()) != s.mesh.F.rows())
      reject(where, fmt::format("{} edge flags for {} triangles", s.wireframe.edges.size(), s.mesh.F.rows()),
             "give one per triangle or none");
  }
}

}  // namespace phiz
