// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/geometry/operators.h"

#include <spdlog/fmt/fmt.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/geometry/surface.h"

namespace phiz {

namespace {

Matrix3d edge_matrix(const MatrixX3d& V, const MatrixX4i& T, Eigen::Index t) {
  Matrix3d D;
  for (int k = 0; k < 3; ++k) D.col(k) = (V.row(T(t, k + 1)) - V.row(T(t, 0))).transpose();
  return D;
}

using Triplets = std::vector<Eigen::Triplet<double>>;

SparseMatrixd assemble(Eigen::Index rows, Eigen::Index cols, const Triplets& entries) {
  SparseMatrixd M(rows, cols);
  M.setFromTriplets(entries.begin(), entries.end());
  return M;
}

}  // namespace

TetRest tet_rest(const MatrixX3d& V, const MatrixX4i& T) {
  TetRest rest;
  rest.inverse_edges.resize(static_cast<std::size_t>(T.rows()));
  rest.volume.resize(T.rows());
  for (Eigen::Index t = 0; t < T.rows(); ++t) {
    const Matrix3d Dm = edge_matrix(V, T, t);
    rest.volume[t] = Dm.determinant() / 6;
    rest.inverse_edges[static_cast<std::size_t>(t)] = Dm.inverse();
    if (!(rest.volume[t] > 0) || !rest.inverse_edges[static_cast<std::size_t>(t)].allFinite())
      reject("tet mesh", fmt::format("tet {} has rest volume {:.3g}", t, rest.volume[t]),
             "every tet must be positively oriented");
  }
  return rest;
}

VectorXd tet_volumes(const MatrixX3d& V, const MatrixX4i& T) {
  VectorXd volumes(T.rows());
  for (Eigen::Index t = 0; t < T.rows(); ++t) volumes[t] = edge_matrix(V, T, t).determinant() / 6;
  return volumes;
}

Eigen::Matrix<double, 3, 4> hat_gradients(const Matrix3d& inverse_edges) {
  Eigen::Matrix<double, 3, 4> G;
  G.rightCols<3>() = inverse_edges.transpose();
  G.col(0) = -G.rightCols<3>().rowwise().sum();
  return G;
}

Matrix3d deformation_gradient(const MatrixX3d& V, const MatrixX4i& T, const TetRest& rest, Eigen::Index tet) {
  return edge_matrix(V, T, tet) * rest.inverse_edges[static_cast<std::size_t>(tet)];
}

std::vector<Matrix3d> deformation_gradients(const MatrixX3d& V, const MatrixX4i& T, const TetRest& rest) {
  std::vector<Matrix3d> F(static_cast<std::size_t>(T.rows()));
  parallel_for(
      T.rows(), [&](Eigen::Index t) { F[static_cast<std::size_t>(t)] = deformation_gradient(V, T, rest, t); }, 2048);
  return F;
}

SparseMatrixd tet_gradient_operator(const MatrixX3d& V, const MatrixX4i& T) {
  const TetRest rest = tet_rest(V, T);
  Triplets entries;
  entries.reserve(static_cast<std::size_t>(T.rows()) * 12);
  for (Eigen::Index t = 0; t < T.rows(); ++t) {
    const auto G = hat_gradients(rest.inverse_edges[static_cast<std::size_t>(t)]);
    for (int row = 0; row < 3; ++row)
      for (int k = 0; k < 4; ++k) entries.emplace_back(3 * t + row, T(t, k), G(row, k));
  }
  return assemble(3 * T.rows(), V.rows(), entries);
}

SparseMatrixd cotangent_laplacian(const MatrixX3d& V, const MatrixX3i& F, const VectorXd& weight) {
  Triplets entries;
  entries.reserve(static_cast<std::size_t>(F.rows()) * 12);
  for (Eigen::Index f = 0; f < F.rows(); ++f)
    for (int k = 0; k < 3; ++k) {
      const int i = F(f, (k + 1) % 3), j = F(f, (k + 2) % 3);
      const Vector3d e1 = V.row(i) - V.row(F(f, k)), e2 = V.row(j) - V.row(F(f, k));
      const double twice_area = e1.cross(e2).norm();
      if (!(twice_area > 1e-14 * (e1.squaredNorm() + e2.squaredNorm()))) continue;
      const double half_cot = 0.5 * (weight.size() > 0 ? weight[f] : 1.0) * e1.dot(e2) / twice_area;
      entries.emplace_back(i, j, -half_cot);
      entries.emplace_back(j, i, -half_cot);
      entries.emplace_back(i, i, half_cot);
      entries.emplace_back(j, j, half_cot);
    }
  return assemble(V.rows(), V.rows(), entries);
}

SparseMatrixd tet_laplacian(const MatrixX3d& V, const MatrixX4i& T, const VectorXd& weight) {
  const TetRest rest = tet_rest(V, T);
  Triplets entries;
  entries.reserve(static_cast<std::size_t>(T.rows()) * 16);
  for (Eigen::Index t = 0; t < T.rows(); ++t) {
    const auto G = hat_gradients(rest.inverse_edges[static_cast<std::size_t>(t)]);
    const double scale = rest.volume[t] * (weight.size() > 0 ? weight[t] : 1.0);
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b) entries.emplace_back(T(t, a), T(t, b), scale * G.col(a).dot(G.col(b)));
  }
  return assemble(V.rows(), V.rows(), entries);
}

VectorXd lumped_triangle_mass(const MatrixX3d& V, const MatrixX3i& F) {
  const VectorXd areas = triangle_areas(V, F);
  VectorXd mass = VectorXd::Zero(V.rows());
  for (Eigen::Index f = 0; f < F.rows(); ++f)
    for (int k = 0; k < 3; ++k) mass[F(f, k)] += areas[f] / 3;
  return mass;
}

VectorXd lumped_tet_mass(const MatrixX3d& V, const MatrixX4i& T, double density) {
  const VectorXd volumes = tet_volumes(V, T);
  VectorXd mass = VectorXd::Zero(V.rows());
  for (Eigen::Index t = 0; t < T.rows(); ++t)
    for (int k = 0; k < 4; ++k) mass[T(t, k)] += density * volumes[t] / 4;
  return mass;
}

Vector3d barycentric(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d ab = b - a, ac = c - a, ap = p - a;
  const Vector3d normal = ab.cross(ac);
  const double squared = normal.squaredNorm();
  const double longest = std::max({ab.squaredNorm(), ac.squaredNorm(), (c - b).squaredNorm()});
  if (squared > 1e-28 * longest * longest) {
    const double v = ap.cross(ac).dot(normal) / squared;
    const double w = ab.cross(ap).dot(normal) / squared;
    return {1 - v - w, v, w};
  }
  // Degenerate: the longest edge stands for the triangle.
  const Vector3d* corners[3] = {&a, &b, &c};
  int first = 0;
  for (int k = 1; k < 3; ++k)
    if ((*corners[(k + 1) % 3] - *corners[k]).squaredNorm() >
        (*corners[(first + 1) % 3] - *corners[first]).squaredNorm())
      first = k;
  const Vector3d edge = *corners[(first + 1) % 3] - *corners[first];
  const double length = edge.squaredNorm();
  const double s = length > 0 ? std::clamp((p - *corners[first]).dot(edge) / length, 0.0, 1.0) : 0.0;
  Vector3d result = Vector3d::Zero();
  result[first] = 1 - s;
  result[(first + 1) % 3] = s;
  return result;
}

Eigen::Vector4d barycentric(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c,
                            const Vector3d& d) {
  Matrix3d D;
  D << b - a, c - a, d - a;
  const Vector3d ap = p - a;
  const double det = D.determinant();
  if (!(std::abs(det) > 0)) return Eigen::Vector4d::Constant(0.25);
  const double v = ap.dot(D.col(1).cross(D.col(2))) / det;
  const double w = ap.dot(D.col(2).cross(D.col(0))) / det;
  const double x = ap.dot(D.col(0).cross(D.col(1))) / det;
  return {1 - v - w - x, v, w, x};
}

}  // namespace phiz
