// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/terms.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
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

/// How R(F S) turns: in the three twist modes of G = F S only, at the rate 2 / (s_i + s_j) each.
struct Twists {
  Svd3 svd;
  Eigen::Matrix<double, 9, 3> modes;  ///< by F, each times S
  Vector3d rates;

  Twists(const Matrix3d& F, const Matrix3d& S) : svd(svd3(F * S)) {
    for (int k = 0; k < 3; ++k) {
      const Matrix3d by_F = twist(k) * S;
      modes.col(k) = Eigen::Map<const Eigen::Matrix<double, 9, 1>>(by_F.data());
      rates[k] = 2 / guarded(svd.s[pairs[k][0]] + svd.s[pairs[k][1]]);
    }
  }

  Matrix3d twist(int k) const {
    const auto [i, j] = pairs[k];
    return std::sqrt(0.5) * (svd.U.col(i) * svd.V.col(j).transpose() - svd.U.col(j) * svd.V.col(i).transpose());
  }

  /// Change of R when G changes by dG.
  Matrix3d turn(const Matrix3d& dG) const {
    Matrix3d dR = Matrix3d::Zero();
    for (int k = 0; k < 3; ++k) {
      const Matrix3d t = twist(k);
      dR += rates[k] * t.cwiseProduct(dG).sum() * t;
    }
    return dR;
  }

  static double guarded(double sum) {
    constexpr double least = 1e-6;
    return std::abs(sum) < least ? std::copysign(least, sum) : sum;
  }
};

}  // namespace

double shape_energy(const Matrix3d& F, const Matrix3d& S) {
  return (F - closest_rotation(F * S) * S).squaredNorm();
}

Matrix3d shape_gradient(const Matrix3d& F, const Matrix3d& S) {
  return 2 * (F - closest_rotation(F * S) * S);
}

Matrix9d shape_hessian(const Matrix3d& F, const Matrix3d& S) {
  const Twists twists(F, S);
  return 2 * (Matrix9d::Identity() - twists.modes * twists.rates.asDiagonal() * twists.modes.transpose());
}

Matrix9d shape_projected_hessian(const Matrix3d& F, const Matrix3d& S) {
  // The identity less a matrix of rank three: what exceeds 1 of that is cut off.
  const Twists twists(F, S);
  const Eigen::HouseholderQR<Eigen::Matrix<double, 9, 3>> qr(twists.modes);
  const Eigen::Matrix<double, 9, 3> Q = qr.householderQ() * Eigen::Matrix<double, 9, 3>::Identity();
  const Matrix3d R = qr.matrixQR().topRows<3>().triangularView<Eigen::Upper>();
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(R * twists.rates.asDiagonal() * R.transpose());
  const Eigen::Matrix<double, 9, 3> axes = Q * eigen.eigenvectors();
  return 2 * (Matrix9d::Identity() - axes * eigen.eigenvalues().cwiseMin(1).asDiagonal() * axes.transpose());
}

Matrix3d shape_gradient_by_stretch(const Matrix3d& F, const Matrix3d& S, const Matrix3d& dS) {
  const Twists twists(F, S);
  return -2 * (twists.svd.U * twists.svd.V.transpose() * dS + twists.turn(F * dS) * S);
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
