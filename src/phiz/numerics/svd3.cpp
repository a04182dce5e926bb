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

/// Root of f, negative at `low` and not negative at `high`, to the resolution of the machine.
template <class Function>
double bisect(Function&& f, double low, double high) {
  for (;;) {
    const double middle = low + 0.5 * (high - low);
    if (middle <= std::min(low, high) || middle >= std::max(low, high)) return middle;
    (f(middle) < 0 ? low : high) = middle;
  }
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
  double excess(double t) const {
    const Vector3d p = at(t);
    return p[0] * p[1] * p[2] - 1;
  }
  double squared_distance(double t) const { return (at(t) - s).squaredNorm(); }
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
  const auto excess = [&family](double t) { return family.excess(t); };
  const double turning = std::max(0.5 * s[2], 0.0);  // below it the last value is on its smaller root
  double best = std::numeric_limits<double>::quiet_NaN();
  if (excess(turning) < 0) {
    double high = std::max(1.0, 2 * turning);
    while (excess(high) < 0) high *= 2;
    best = bisect(excess, turning, high);
  }
  if (turning > 0) {
    // Far from 1 a single small value can be nearer than three middling ones. The product rises to one peak and falls
    // again.
    double low = 0, high = turning;
    for (int i = 0; i < 80; ++i) {
      const double a = low + 0.382 * (high - low), b = low + 0.618 * (high - low);
      (excess(a) < excess(b) ? low : high) = excess(a) < excess(b) ? a : b;
    }
    const double peak = excess(turning) >= 0 && excess(low) < 0 ? turning : low;
    if (excess(peak) >= 0) {
      const double root = bisect(excess, 0.0, peak);
      if (std::isnan(best) || family.squared_distance(root) < family.squared_distance(best)) best = root;
    }
  }
  return family.at(best);
}

Matrix3d closest_unimodular(const Matrix3d& A) {
  const Svd3 svd = svd3(A);
  return svd.U * closest_unimodular_values(svd.s).asDiagonal() * svd.V.transpose();
}

}  // namespace phiz
