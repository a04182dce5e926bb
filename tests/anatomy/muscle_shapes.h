// SPDX-License-Identifier: GPL-3.0-or-later
/// Muscles of simple form for tests.
#pragma once

#include <algorithm>
#include <vector>

#include "geometry/shapes.h"
#include "phiz/anatomy/builtin/mouth/loft.h"
#include "phiz/anatomy/fibre_field.h"
#include "phiz/anatomy/head_template.h"
#include "phiz/geometry/remesh.h"

namespace phiz::test {

/// A rod with round ends from a to b, metres.
inline TriangleMesh rod(const Vector3d& a, const Vector3d& b, double radius) {
  const auto distance = [=](const Vector3d& p) {
    const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    return (p - a - t * (b - a)).norm() - radius;
  };
  PolygoniseOptions options;
  options.edge_length = 0.4 * radius;
  const Vector3d rim = Vector3d::Constant(3 * radius);
  return polygonise(distance, {a.cwiseMin(b) - rim, a.cwiseMax(b) + rim}, options);
}

inline MuscleShape rod_muscle(const Vector3d& a, const Vector3d& b, double radius) {
  return {"rod", rod(a, b, radius), a.transpose(), b.transpose()};
}

/// A block of flesh: `cells` cubes a side from `low`, each of edge `edge`, six tets each.
inline TetMesh flesh_block(const Vector3d& low, double edge, int cells) {
  const int n = cells + 1;
  TetMesh mesh;
  mesh.V.resize(n * n * n, 3);
  for (int v = 0; v < n * n * n; ++v)
    mesh.V.row(v) = (low + edge * Vector3d(v % n, v / n % n, v / (n * n))).transpose();
  std::vector<Eigen::Vector4i> tets;
  const int paths[6][3] = {{1, n, n * n}, {n, n * n, 1}, {n * n, 1, n}, {n, 1, n * n}, {1, n * n, n}, {n * n, n, 1}};
  for (int z = 0; z < cells; ++z)
    for (int y = 0; y < cells; ++y)
      for (int x = 0; x < cells; ++x)
        for (int p = 0; p < 6; ++p) {
          const int a = x + n * (y + n * z), b = a + paths[p][0], c = b + paths[p][1], d = c + paths[p][2];
          tets.push_back(p < 3 ? Eigen::Vector4i(a, b, c, d) : Eigen::Vector4i(a, c, b, d));
        }
  mesh.T.resize(static_cast<Eigen::Index>(tets.size()), 4);
  for (std::size_t t = 0; t < tets.size(); ++t) mesh.T.row(static_cast<Eigen::Index>(t)) = tets[t].transpose();
  mesh.region = VectorXi::Constant(mesh.T.rows(), Tissue::flesh);
  return mesh;
}

}  // namespace phiz::test
