// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/numerics/svd3.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "phiz/core/error.h"

namespace phiz {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

Vector3d any_perpendicular(const Vector3d& unit) {
  Eigen::Index least = 0;
  unit.cwiseAbs().minCoeff(&least);
  return unit.cross(Vector3d::Unit(least)).normalized();
}

/// Makes columns p and q of B perpendicular by a rotation, applied to V too. False when they were already.
bool rotate_columns(Matrix3d& B, Matrix3d& V, int p, int q) {
  const double a = B.col(p).squaredNorm(), b = B.col(q).squaredNorm(), c = B.col(p).dot(B.col(q));
  if (std::abs(c) <= epsilon * std::sqrt(a * b)) return false;
  const double zeta = (b - a) / (2 * c);
  const double t = std::copysign(1.0, zeta) / (std::abs(zeta) + std::hypot(1.0, zeta));
  const double cosine = 1 / std::sqrt(1 + t * t), sine = cosine * t;
  for (Matrix3d* M : {&B, &V}) {
    const Vector3d left = M->col(p);
    M->col(p) = cosine * left - sine * M->col(q);
    M->col(q) = sine * left + cosine * M->col(q);
  }
  return true;
}

/// Values of product 1 as a function of the last one, t: the stationary points with p0, p1 on the larger root of
/// p (p - s) = mu, mu = t (t - s2). At a minimum only one value can be on the smaller root, and that is the last.
struct UnimodularFamily {
  Vector3d s;

  Vector3d at(double t) const {
    const double mu = t * (t - s[2]);
    const auto larger_root = [mu](double v) {
      return 0.5 * (v + std::sqrt(std::max(0.0, v * v + 4 * mu)));  // v >= 0
    };
    return {larger_root(s[0]), larger_root(s[1]), t};
  }
  /// Negative where the product is below 1.
  double excess(double t) const { return at(t).prod() - 1; }
  double squared_distance(double t) const { return (at(t) - s).squaredNorm(); }

  /// Root of the excess, which is negative at `low` and not at `high`: Newton on log(product) over log(t), else
  /// bisection.
  double root(double low, double high) const {
    double t = high;
    for (int i = 0; i < 200; ++i) {
      const Vector3d p = at(t);
      const double product = p.prod();
      (product < 1 ? low : high) = t;
      const double slope = 2 * t - s[2];
      const double relative = 1 + t * slope / (p[0] * (2 * p[0] - s[0])) + t * slope / (p[1] * (2 * p[1] - s[1]));
      double next = t * std::exp(-std::log(product) / relative);
      if (!(next > low && next < high)) next = low + 0.5 * (high - low);
      if (std::abs(next - t) <= 2 * epsilon * t || next <= low || next >= high) return next;
      t = next;
    }
    return t;
  }
};

}  // namespace

Svd3 svd3(const Matrix3d& A) {
  if (!A.allFinite()) fail("a 3x3 matrix to be decomposed is not finite");
  const double scale = A.cwiseAbs().maxCoeff();
  if (scale == 0) return {Matrix3d::Identity(), Vector3d::Zero(), Matrix3d::Identity()};
  Matrix3d B = A / scale, V = Matrix3d::Identity();
  bool turned = true;
  for (int sweep = 0; turned && sweep < 20; ++sweep) {
    turned = false;
    for (const auto& [p, q] : {std::pair{0, 1}, std::pair{0, 2}, std::pair{1, 2}})
      if (rotate_columns(B, V, p, q)) turned = true;
  }
  // Largest first; each exchange flips one column so that det V stays 1.
  for (const auto& [p, q] : {std::pair{0, 1}, std::pair{0, 2}, std::pair{1, 2}})
    if (B.col(p).squaredNorm() < B.col(q).squaredNorm())
      for (Matrix3d* M : {&B, &V}) {
        M->col(p).swap(M->col(q));
        M->col(q) *= -1;
      }
  Svd3 out;
  out.V = V;
  out.s[0] = B.col(0).norm();
  out.U.col(0) = B.col(0) / out.s[0];
  const Vector3d second = B.col(1) - out.U.col(0).dot(B.col(1)) * out.U.col(0);
  const double length = second.norm();
  out.U.col(1) =
      length > std::numeric_limits<double>::min() ? Vector3d(second / length) : any_perpendicular(out.U.col(0));
  out.s[1] = std::min(length, out.s[0]);  // equal values may differ by rounding
  out.U.col(2) = out.U.col(0).cross(out.U.col(1));
  out.s[2] = std::clamp(out.U.col(2).dot(B.col(2)), -out.s[1], out.s[1]);
  out.s *= scale;
  return out;
}

Matrix3d closest_rotation(const Matrix3d& A) {
  const Svd3 svd = svd3(A);
  return svd.U * svd.V.transpose();
}

Vector3d closest_unimodular_values(const Vector3d& s) {
  const UnimodularFamily family{s};
  const double turning = std::max(0.5 * s[2], 0.0);  // below it the last value is on its smaller root
  if (turning > 0 && family.excess(turning) >= 0) return family.at(family.root(0, turning));
  double high = std::max(1.0, 2 * turning);
  while (family.excess(high) < 0) high *= 2;
  const double middling = family.root(turning, high);
  if (s.prod() < 3) return family.at(middling);
  // Far from 1 a single small value can be nearer than three middling ones: the product may peak below the turning
  // point.
  double low = 0, peak = turning;
  for (int i = 0; i < 40; ++i) {
    const double a = low + 0.382 * (peak - low), b = low + 0.618 * (peak - low);
    (family.excess(a) < family.excess(b) ? low : peak) = family.excess(a) < family.excess(b) ? a : b;
  }
  if (family.excess(peak) < 0) return family.at(middling);
  const double small = family.root(0, peak);
  return family.at(family.squared_distance(small) < family.squared_distance(middling) ? small : middling);
}

Matrix3d closest_unimodular(const Matrix3d& A) {
  const Svd3 svd = svd3(A);
  return svd.U * closest_unimodular_values(svd.s).asDiagonal() * svd.V.transpose();
}

}  // namespace phiz
