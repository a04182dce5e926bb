// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/projections.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace phiz {

namespace {

/// The larger root of p (p - s) = kappa.
double plus_root(double s, double kappa) {
  const double d = std::sqrt(std::max(0.0, s * s + 4 * kappa));
  return s >= 0 ? 0.5 * (s + d) : 2 * kappa / (d - s);
}

/// Root of a function that ascends through zero in [low, high]: bisection, finished by the machine's resolution.
template <class Function>
double bisect(Function&& f, double low, double high) {
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    (f(middle) < 0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

SignedSvd signed_svd(const Matrix3d& F) {
  const Eigen::JacobiSVD<Matrix3d> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
  SignedSvd out{svd.matrixU(), svd.singularValues(), svd.matrixV()};
  if (out.U.determinant() < 0) {
    out.U.col(2) *= -1;
    out.s[2] *= -1;
  }
  if (out.V.determinant() < 0) {
    out.V.col(2) *= -1;
    out.s[2] *= -1;
  }
  return out;
}

Matrix3d nearest_rotation(const Matrix3d& F) {
  const SignedSvd svd = signed_svd(F);
  return svd.U * svd.V.transpose();
}

Vector3d nearest_unimodular_values(const Vector3d& s) {
  // Stationary points of |p - s|^2 on p0 p1 p2 = 1 with all p positive: p_i (p_i - s_i) = kappa. Of the two roots of
  // this quadratic, p0 and p1 take the larger; p2 takes the smaller one only if even kappa = -s2^2/4 leaves the product
  // above 1.
  const auto product = [&](double kappa) {
    return plus_root(s[0], kappa) * plus_root(s[1], kappa) * plus_root(s[2], kappa);
  };
  const double lowest = s[2] > 0 ? -0.25 * s[2] * s[2] : 0.0;
  double kappa = lowest;
  if (product(lowest) <= 1) {
    double high = std::max(1.0, lowest + 1.0);
    while (product(high) < 1) high *= 4;
    kappa = bisect([&](double k) { return product(k) - 1; }, lowest, high);
    return {plus_root(s[0], kappa), plus_root(s[1], kappa), plus_root(s[2], kappa)};
  }
  const double p2 =
      bisect([&](double p) { return plus_root(s[0], p * (p - s[2])) * plus_root(s[1], p * (p - s[2])) * p - 1; }, 0.0,
             0.5 * s[2]);
  kappa = p2 * (p2 - s[2]);
  return {plus_root(s[0], kappa), plus_root(s[1], kappa), p2};
}

Matrix3d nearest_unimodular(const Matrix3d& F) {
  const SignedSvd svd = signed_svd(F);
  return svd.U * nearest_unimodular_values(svd.s).asDiagonal() * svd.V.transpose();
}

}  // namespace phiz
