// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/terms.h"

#include <cmath>

#include "phiz/numerics/svd3.h"

namespace phiz {

namespace {

constexpr int pairs[3][2] = {{0, 1}, {1, 2}, {2, 0}};

/// u_i v_j^T as a 9-vector.
Eigen::Matrix<double, 9, 1> outer(const Svd3& svd, int i, int j) {
  const Matrix3d m = svd.U.col(i) * svd.V.col(j).transpose();
  return Eigen::Map<const Eigen::Matrix<double, 9, 1>>(m.data());
}

}  // namespace

double shape_energy(const Matrix3d& F, const Matrix3d& S) {
  return (F - closest_rotation(F * S) * S).squaredNorm();
}

Matrix3d shape_gradient(const Matrix3d& F, const Matrix3d& S) {
  return 2 * (F - closest_rotation(F * S) * S);
}

Matrix9d shape_hessian(const Matrix3d& F, const Matrix3d& S) {
  // R(F S) turns in the three twist modes of G = F S only, at the rate 2 / (s_i + s_j) each.
  const Svd3 svd = svd3(F * S);
  Matrix9d H = 2 * Matrix9d::Identity();
  for (const auto& [i, j] : pairs) {
    const Matrix3d twist =
        std::sqrt(0.5) * (svd.U.col(i) * svd.V.col(j).transpose() - svd.U.col(j) * svd.V.col(i).transpose()) * S;
    const Eigen::Map<const Eigen::Matrix<double, 9, 1>> u(twist.data());
    H -= 2 * (2 / (svd.s[i] + svd.s[j])) * u * u.transpose();
  }
  return H;
}

double volume_energy(const Matrix3d& F) {
  return (F - closest_unimodular(F)).squaredNorm();
}

Matrix3d volume_gradient(const Matrix3d& F) {
  return 2 * (F - closest_unimodular(F));
}

Matrix9d volume_hessian(const Matrix3d& F) {
  const Svd3 svd = svd3(F);
  const Vector3d p = closest_unimodular_values(svd.s);
  const double kappa = p[0] * (p[0] - svd.s[0]);
  // From p_i - s_i = kappa / p_i and prod p = 1: dp_i = (ds_i + dkappa / p_i) / a_i with a_i = 1 + kappa / p_i^2, and
  // sum dp_i / p_i = 0 gives dkappa.
  const Vector3d a = (1 + kappa * p.array().square().inverse()).matrix();
  const Vector3d c = (p.array() * a.array()).inverse().matrix();
  const double k = (p.array().square() * a.array()).inverse().sum();
  Matrix3d dp = a.cwiseInverse().asDiagonal();
  dp -= c * c.transpose() / k;

  Matrix9d dP = Matrix9d::Zero();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) dP += dp(i, j) * outer(svd, i, i) * outer(svd, j, j).transpose();
  for (const auto& [i, j] : pairs) {
    const auto flip = (outer(svd, i, j) + outer(svd, j, i)).eval();
    const auto twist = (outer(svd, i, j) - outer(svd, j, i)).eval();
    // (p_i - p_j) / (s_i - s_j) without the cancellation: from p_i (p_i - s_i) = p_j (p_j - s_j).
    const double difference = 1 / (1 + kappa / (p[i] * p[j]));
    const double sum = (p[i] + p[j]) / (svd.s[i] + svd.s[j]);
    dP += 0.5 * difference * flip * flip.transpose() + 0.5 * sum * twist * twist.transpose();
  }
  return 2 * (Matrix9d::Identity() - dP);
}

double target_energy(const Matrix3d& F, const Matrix3d& target) {
  return (F - target).squaredNorm();
}

Matrix3d target_gradient(const Matrix3d& F, const Matrix3d& target) {
  return 2 * (F - target);
}

double attachment_energy(const Vector3d& x, const Vector3d& point) {
  return (x - point).squaredNorm();
}

Vector3d attachment_gradient(const Vector3d& x, const Vector3d& point) {
  return 2 * (x - point);
}

double plane_energy(const Vector3d& x, const Vector3d& point, const Vector3d& normal) {
  const double d = normal.dot(x - point);
  return d * d;
}

Vector3d plane_gradient(const Vector3d& x, const Vector3d& point, const Vector3d& normal) {
  return 2 * normal.dot(x - point) * normal;
}

}  // namespace phiz
