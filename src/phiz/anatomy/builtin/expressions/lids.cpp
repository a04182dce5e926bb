// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/expressions/lids.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "phiz/anatomy/builtin/ease.h"
#include "phiz/anatomy/builtin/expressions/skin.h"

namespace phiz {
namespace {

constexpr int stations = 33;
constexpr double degree = std::numbers::pi / 180;
constexpr double closed_at = 0.14;     ///< where the lids meet: share of the fissure, from the lower margin
constexpr double half_gap = 0.006;     ///< that each lid keeps from there, radians about the middle of the eye
constexpr double clearance = 0.00012;  ///< that lids keep from the eyeball, metres

double sample(const VectorXd& values, double across) {
  const double at = std::clamp(across, 0.0, 1.0) * static_cast<double>(values.size() - 1);
  const auto i = std::min(static_cast<Eigen::Index>(at), values.size() - 2);
  const double t = at - static_cast<double>(i);
  return (1 - t) * values[i] + t * values[i + 1];
}

}  // namespace

double EyeShape::bulge(const Vector3d& direction, const Vector3d& gaze) const {
  const double angle = std::acos(std::clamp(direction.dot(gaze), -1.0, 1.0));
  if (angle >= cornea_angle) return 0;
  const double c = std::cos(0.5 * std::numbers::pi * angle / cornea_angle);
  return cornea_height * c * c;
}

LidControl::LidControl(const HeadTemplate& head, const EyeShape& eye, const std::string& side)
    : eye_(eye), sign_(side == "left" ? 1 : -1) {
  const MatrixX3d upper = skin_curve(head, "loop:" + side + "UpperLidMargin");
  const MatrixX3d lower = skin_curve(head, "loop:" + side + "LowerLidMargin");
  // The canthi are the ends of the margins.
  const auto inner_end = [&](const MatrixX3d& loop) {
    const bool first = sign_ * loop(0, 0) < sign_ * loop(loop.rows() - 1, 0);
    return Vector3d(loop.row(first ? 0 : loop.rows() - 1));
  };
  const auto outer_end = [&](const MatrixX3d& loop) {
    const bool first = sign_ * loop(0, 0) > sign_ * loop(loop.rows() - 1, 0);
    return Vector3d(loop.row(first ? 0 : loop.rows() - 1));
  };
  const Vector3d inner = 0.5 * (inner_end(upper) + inner_end(lower));
  const Vector3d outer = 0.5 * (outer_end(upper) + outer_end(lower));
  axis_ = (outer - inner).normalized();
  ahead_ = (Vector3d::UnitZ() - Vector3d::UnitZ().dot(axis_) * axis_).normalized();
  up_ = ahead_.cross(axis_).normalized();
  if (up_.y() < 0) up_ = -up_;
  const double length = (outer - inner).norm();
  const auto across = [&](const Vector3d& p) { return (p - inner).dot(axis_) / length; };
  const auto margin_angles = [&](const MatrixX3d& loop) {
    std::vector<std::pair<double, double>> points;
    for (Eigen::Index i = 0; i < loop.rows(); ++i)
      points.emplace_back(across(loop.row(i).transpose()), elevation(loop.row(i).transpose()));
    std::sort(points.begin(), points.end());
    VectorXd angles(stations);
    std::size_t i = 0;
    for (int k = 0; k < stations; ++k) {
      const double a = k / double(stations - 1);
      while (i + 2 < points.size() && points[i + 1].first < a) ++i;
      const double span = points[i + 1].first - points[i].first;
      const double t = span > 1e-12 ? std::clamp((a - points[i].first) / span, 0.0, 1.0) : 0;
      angles[k] = (1 - t) * points[i].second + t * points[i + 1].second;
    }
    return angles;
  };
  nearness_.setZero(head.volume.V.rows());
  upper_angle_ = margin_angles(upper);
  lower_angle_ = margin_angles(lower);
  const auto margin_height = [&](const MatrixX3d& loop, double a) {  // of the outer edge of the margin, near `a`
    double sum = 0, weights = 0;
    for (Eigen::Index i = 0; i < loop.rows(); ++i) {
      const Vector3d p = loop.row(i);
      const double w = std::exp(-std::pow((across(p) - a) / 0.08, 2)) + 1e-12;
      sum += w * (p - eye_.centre).norm();
      weights += w;
    }
    return sum / weights;
  };

  for (Eigen::Index i = 0; i < head.skin_vertices.size(); ++i) {
    const int v = head.skin_vertices[i];
    const Vector3d X = head.volume.V.row(v).transpose();
    const double distance = (X - eye_.centre).norm();
    if (distance > eye_.radius + 0.010) continue;
    near_.emplace_back(v, distance);
    if (distance < eye_.radius + 0.0015) nearness_[v] = 1;
    if ((X - eye_.centre).dot(ahead_) < 0.15 * eye_.radius) continue;
    LidVertex lid{v, across(X), elevation(X), 0, 0, distance, true, X};
    const double top = sample(upper_angle_, lid.across), bottom = sample(lower_angle_, lid.across);
    lid.upper = lid.elevation > 0.5 * (top + bottom);
    const double beyond = lid.upper ? lid.elevation - top : bottom - lid.elevation;
    const double aside = std::max({0.0, -lid.across, lid.across - 1}) * length;
    const double near = 1 - smoothstep(0.004, 0.009, distance - eye_.radius);
    lid.follow =
        (1 - smoothstep(6 * degree, (lid.upper ? 66 : 55) * degree, beyond)) * (1 - smoothstep(0, 0.006, aside));
    lid.weight = 8 * (1 - smoothstep(10 * degree, 48 * degree, beyond)) * near * (1 - smoothstep(0.001, 0.006, aside));
    lid.flat = std::min(distance, margin_height(lid.upper ? upper : lower, std::clamp(lid.across, 0.0, 1.0)) + 0.0003);
    nearness_[v] = std::max(nearness_[v], std::min(1.0, lid.weight / 4));
    if (lid.weight > 0) vertices_.push_back(lid);
  }
}

double LidControl::elevation(const Vector3d& p) const {
  const Vector3d d = p - eye_.centre;
  return std::atan2(d.dot(up_), d.dot(ahead_));
}

Vector3d LidControl::gaze(const LidMotion& motion) const {
  return Eigen::AngleAxisd(sign_ * motion.bulge_side * degree, Vector3d::UnitY()) *
         (Eigen::AngleAxisd(-motion.bulge_up * degree, Vector3d::UnitX()) * Vector3d::UnitZ());
}

std::vector<Handle> LidControl::handles(const LidMotion& motion) const {
  const Vector3d look = gaze(motion);
  // Turning about axis_ by a positive angle lifts when axis_ x ahead_ points up.
  const double lift = axis_.cross(ahead_).dot(up_) > 0 ? 1 : -1;
  std::vector<Handle> result;
  for (const LidVertex& v : vertices_) {
    const double fissure = sample(upper_angle_, v.across) - sample(lower_angle_, v.across);
    const double turn = v.upper ? -motion.upper * fissure : motion.lower * fissure;
    Vector3d d = Eigen::AngleAxisd(lift * v.follow * turn, axis_) * (v.rest - eye_.centre);
    d = Eigen::AngleAxisd(sign_ * motion.sideways * v.follow * degree, Vector3d::UnitY()) * d;
    // The fold above the eye unrolls and lies flat on the globe.
    const double drawn = smoothstep(0, 25 * degree, std::abs(v.follow * turn)) * ((turn < 0) == v.upper ? 1 : 0);
    d *= 1 - drawn * (1 - v.flat / (v.rest - eye_.centre).norm());
    if (v.follow > 0.5 && motion.upper + motion.lower > 0.9) {  // neither lid passes the line where they meet
      const double meeting = sample(lower_angle_, v.across) + closed_at * fissure;
      const double at = std::atan2(d.dot(up_), d.dot(ahead_));
      const double gap = std::min(half_gap, 0.1 * fissure);
      const double past = v.upper ? meeting + gap - at : at - meeting + gap;
      if (past > 0) d = Eigen::AngleAxisd(lift * (v.upper ? past : -past), axis_) * d;
    }
    const Vector3d direction = d.normalized(), before = (v.rest - eye_.centre).normalized();
    d += direction * (eye_.bulge(direction, look) - eye_.bulge(before, Vector3d::UnitZ()));
    result.push_back({v.vertex, eye_.centre + d, v.weight});
  }
  return result;
}

Vector3d LidControl::outside(const Vector3d& x, double distance, const Vector3d& look) const {
  const Vector3d d = x - eye_.centre;
  const double r = d.norm();
  if (r < 1e-6) return x;
  const double least = std::min(distance, eye_.radius + clearance) + eye_.bulge(d / r, look);
  return r < least ? Vector3d(eye_.centre + d * (least / r)) : x;
}

Obstacle LidControl::eyeball(const LidMotion& motion) const {
  Obstacle obstacle;
  for (const auto& [vertex, distance] : near_) obstacle.vertices.push_back(vertex);
  obstacle.weight = 3;
  const Vector3d look = gaze(motion);
  obstacle.allowed = [this, look](std::size_t k, const Vector3d& x) { return outside(x, near_[k].second, look); };
  return obstacle;
}

void LidControl::lift_off(const MatrixX3d& rest, MatrixX3d& displacement, const LidMotion& motion) const {
  const Vector3d look = gaze(motion);
  for (Eigen::Index v = 0; v < rest.rows(); ++v) {
    const Vector3d X = rest.row(v);
    const double distance = (X - eye_.centre).norm();
    if (distance > eye_.radius + 0.002) continue;
    const Vector3d x = X + displacement.row(v).transpose();
    displacement.row(v) += (outside(x, distance, look) - x).transpose();
  }
}

}  // namespace phiz
