// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/face/surface_gradients.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace phiz {

namespace {

Matrix3d frame(const MatrixX3d& V, const MatrixX3i& F, Eigen::Index f) {
  const Vector3d p = V.row(F(f, 0));
  Matrix3d edges;
  edges.col(0) = V.row(F(f, 1)).transpose() - p;
  edges.col(1) = V.row(F(f, 2)).transpose() - p;
  const Vector3d n = edges.col(0).cross(edges.col(1));
  const double length = n.norm();
  edges.col(2) = length > 0 ? Vector3d(n / std::sqrt(length)) : Vector3d(Vector3d::Zero());
  return edges;
}

}  // namespace

std::vector<Matrix3d> surface_gradients(const MatrixX3d& rest, const MatrixX3d& deformed, const MatrixX3i& triangles) {
  std::vector<Matrix3d> gradients(static_cast<std::size_t>(triangles.rows()), Matrix3d::Identity());
  for (Eigen::Index f = 0; f < triangles.rows(); ++f) {
    const Matrix3d before = frame(rest, triangles, f);
    const double scale = before.col(0).norm() * before.col(1).norm() * before.col(2).norm();
    if (!(std::abs(before.determinant()) > 1e-9 * scale)) continue;
    gradients[static_cast<std::size_t>(f)] = frame(deformed, triangles, f) * before.inverse();
  }
  return gradients;
}

}  // namespace phiz
