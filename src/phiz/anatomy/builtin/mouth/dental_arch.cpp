// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/mouth/dental_arch.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace phiz {
namespace {
constexpr int steps = 512;
constexpr double quarter = std::numbers::pi / 2;
}  // namespace

ArchCurve::ArchCurve(double half_width, double depth, double z0)
    : half_width_(half_width), depth_(depth), z0_(z0), arc_(steps + 1) {
  arc_(0) = 0;
  for (int i = 1; i <= steps; ++i) {
    const double a = quarter * (i - 0.5) / steps;
    arc_(i) = arc_(i - 1) + std::hypot(half_width * std::cos(a), depth * std::sin(a)) * quarter / steps;
  }
  length_ = arc_(steps);
}

double ArchCurve::angle(double s) const {
  const auto above = std::upper_bound(arc_.begin(), arc_.end(), std::clamp(s, 0.0, length_));
  const auto i = std::clamp<Eigen::Index>(above - arc_.begin() - 1, 0, steps - 1);
  const double t = (std::clamp(s, 0.0, length_) - arc_(i)) / (arc_(i + 1) - arc_(i));
  return quarter * (static_cast<double>(i) + t) / steps;
}

Vector2d ArchCurve::point(double s) const {
  const double a = angle(s);
  return {half_width_ * std::sin(a), z0_ + depth_ * std::cos(a) - std::max(0.0, s - length_)};
}

Vector2d ArchCurve::tangent(double s) const {
  const double a = angle(s);
  return Vector2d(half_width_ * std::cos(a), -depth_ * std::sin(a)).normalized();
}

Vector2d ArchCurve::outward(double s) const {
  const Vector2d t = tangent(s);
  return {-t.y(), t.x()};
}

ArchCurve upper_arch(const Proportions::DentalArch& arch) {
  return {arch.half_width, arch.depth, arch.z0};
}

ArchCurve lower_arch(const Proportions::DentalArch& arch) {
  return {arch.half_width - arch.lower_inset, arch.depth - arch.lower_inset, arch.z0};
}

}  // namespace phiz
