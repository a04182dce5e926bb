// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/expressions/lids.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "phiz/anatomy/builtin/ease.h"
#include "phiz/anatomy/builtin/expressions/skin.h"

namespace phiz {
namespace {

constexpr int lid_stations = 33;
constexpr double degree = std::numbers::pi / 180;
constexpr double clearance = 0.00012;            ///< that lids keep from the eyeball, metres
constexpr double closed_gap = 0.4 * degree;      ///< between the inner edges of margins that meet
constexpr double closed_margins = 1.2 * degree;  ///< that margins which meet take up together
constexpr double tarsus = 7 * degree;            ///< of the upper lid that goes with its margin as a whole
constexpr double cheek_reach = 55 * degree;      ///< below the lower margin

/// Stations gather at the canthi, where margins turn in.
double station(int k) {
  return 0.5 * (1 - std::cos(std::numbers::pi * k / (lid_stations - 1)));
}

double sample(const VectorXd& values, double across) {
  const double at = std::acos(1 - 2 * std::clamp(across, 0.0, 1.0)) / std::numbers::pi * (lid_stations - 1);
  const auto i = std::min(static_cast<Eigen::Index>(at), values.size() - 2);
  const double t = at - static_cast<double>(i);
  return (1 - t) * values[i] + t * values[i + 1];
}

/// Values at the stations through scattered (across, value) points, linear between them.
VectorXd through(std::vector<std::pair<double, double>> points) {
  std::sort(points.begin(), points.end());
  VectorXd values(lid_stations);
  std::size_t i = 0;
  for (int k = 0; k < lid_stations; ++k) {
    const double a = station(k);
    while (i + 2 < points.size() && points[i + 1].first < a) ++i;
    const double span = points[i + 1].first - points[i].first;
    const double t = span > 1e-12 ? std::clamp((a - points[i].first) / span, 0.0, 1.0) : 0;
    values[k] = (1 - t) * points[i].second + t * points[i + 1].second;
  }
  return values;
}

/// The least of scattered values near every station (within 4 % of the way across); `otherwise` where there is none.
VectorXd least_near(const std::vector<std::pair<double, double>>& points, const VectorXd& otherwise) {
  VectorXd values = otherwise;
  for (int k = 0; k < lid_stations; ++k) {
    double least = 1e30;
    for (const auto& [across, value] : points)
      if (std::abs(across - station(k)) < 0.04) least = std::min(least, value);
    if (least < 1e30) values[k] = least;
  }
  const VectorXd rough = values;
  for (int k = 1; k + 1 < lid_stations; ++k) values[k] = 0.25 * (rough[k - 1] + 2 * rough[k] + rough[k + 1]);
  return values;
}

/// 0 below `from`, 1 above `to`; rises at most 1.25 times as steeply as a straight line.
double unfold(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return 0.5 * (t + t * t * (3 - 2 * t));
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
  const auto end = [&](const MatrixX3d& loop, double towards) {
    const bool first = towards * sign_ * loop(0, 0) > towards * sign_ * loop(loop.rows() - 1, 0);
    return Vector3d(loop.row(first ? 0 : loop.rows() - 1));
  };
  inner_ = 0.5 * (end(upper, -1) + end(lower, -1));
  const Vector3d outer = 0.5 * (end(upper, 1) + end(lower, 1));
  axis_ = (outer - inner_).normalized();
  ahead_ = (Vector3d::UnitZ() - Vector3d::UnitZ().dot(axis_) * axis_).normalized();
  up_ = ahead_.cross(axis_).normalized();
  if (up_.y() < 0) up_ = -up_;
  length_ = (outer - inner_).norm();

  using Points = std::vector<std::pair<double, double>>;
  const auto collect = [&](const MatrixX3d& X, double Place::*field, double factor) {
    Points points;
    for (Eigen::Index i = 0; i < X.rows(); ++i) {
      const Place p = place(X.row(i).transpose());
      points.emplace_back(p.across, factor * p.*field);
    }
    return points;
  };
  const auto of_region = [&](const std::string& name, double factor) {
    const VectorXi& rows = skin_region(head, side + name);
    return collect(head.skin.V(std::vector<int>(rows.begin(), rows.end()), Eigen::all), &Place::elevation, factor);
  };
  VectorXd &bottom = curves_[0], &bottom_inner = curves_[1], &top_inner = curves_[2], &top = curves_[3],
           &orbit = curves_[4];
  bottom = through(collect(lower, &Place::elevation, 1));
  top = through(collect(upper, &Place::elevation, 1));
  upper_height_ = through(collect(upper, &Place::distance, 1));
  lower_height_ = through(collect(lower, &Place::distance, 1));
  // The inner edges are the lowest place of the upper lid and the highest one of the lower lid.
  top_inner = least_near(of_region("UpperLid", 1), top).cwiseMin(top);
  bottom_inner = (-least_near(of_region("LowerLid", -1), -bottom)).cwiseMax(bottom);
  for (int k = 0; k < lid_stations; ++k) {
    if (top[k] < bottom[k]) top[k] = bottom[k] = 0.5 * (top[k] + bottom[k]);
    const double middle = std::clamp(0.5 * (top_inner[k] + bottom_inner[k]), bottom[k], top[k]);
    top_inner[k] = std::clamp(top_inner[k], middle, top[k]);
    bottom_inner[k] = std::clamp(bottom_inner[k], bottom[k], middle);
  }
  orbit = least_near(of_region("Brow", 1), top.array() + 30 * degree);
  orbit = (orbit.array() - degree).matrix().cwiseMax(top + VectorXd::Constant(lid_stations, 14 * degree));
  orbit = orbit.cwiseMin(top + VectorXd::Constant(lid_stations, 34 * degree));

  nearness_.setZero(head.volume.V.rows());
  for (const int v : head.skin_vertices) {
    const Vector3d X = head.volume.V.row(v).transpose(), d = X - eye_.centre;
    const double distance = d.norm();
    if (distance > eye_.radius + 0.026) continue;
    const Place p = place(X);
    if (distance < eye_.radius + 0.010) near_.emplace_back(v, distance);
    if (distance < eye_.radius + 0.0015) nearness_[v] = 1;
    if (d.dot(ahead_) < 0.15 * eye_.radius) continue;
    if (lead(p) > 0) {
      nearness_[v] = std::max(nearness_[v], std::min(1.0, 2 * lead(p)));
      led_.emplace_back(v, X);
    } else if (p.elevation > sample(orbit, p.across) && p.across > -0.5 && p.across < 1.4) {
      brow_.emplace_back(v, X);
    }
  }
}

LidControl::Place LidControl::place(const Vector3d& X) const {
  const Vector3d d = X - eye_.centre;
  return {(X - inner_).dot(axis_) / length_, std::atan2(d.dot(up_), d.dot(ahead_)), d.norm()};
}

LidControl::Fissure LidControl::fissure(double across) const {
  return {sample(curves_[0], across), sample(curves_[1], across), sample(curves_[2], across),
          sample(curves_[3], across), sample(curves_[4], across)};
}

LidControl::Fissure LidControl::moved(const Fissure& rest, const LidMotion& motion) const {
  const double open = rest.upper - rest.lower;
  Fissure f = rest;
  f.upper -= motion.upper * open;
  f.lower += motion.lower * open;
  const double least = std::min(closed_margins, 0.5 * open);
  if (f.upper - f.lower < least) {  // margins that meet press against each other halfway
    const double meeting = 0.5 * (f.upper + f.lower);
    f.upper = meeting + 0.5 * least;
    f.lower = meeting - 0.5 * least;
  }
  const double margins = rest.upper - rest.upper_inner + rest.lower_inner - rest.lower;
  const double gap = std::min({closed_gap, rest.upper_inner - rest.lower_inner, 0.4 * (f.upper - f.lower)});
  const double share = margins > 0 ? std::min(1.0, (f.upper - f.lower - gap) / margins) : 1;
  f.upper_inner = f.upper - share * (rest.upper - rest.upper_inner);
  f.lower_inner = f.lower + share * (rest.lower_inner - rest.lower);
  return f;
}

double LidControl::lead(const Place& p) const {
  const Fissure f = fissure(p.across);
  const double aside = std::max({0.0, -p.across, p.across - 1}) * length_;
  const double beside = 1 - smoothstep(0.001, 0.006, aside);
  if (p.elevation > f.upper)
    return beside * (1 - smoothstep(0.006, 0.011, p.distance - eye_.radius)) *
           (1 - smoothstep(0.7 * (f.orbit - f.upper), f.orbit - f.upper, p.elevation - f.upper));
  return beside * (1 - smoothstep(0.004, 0.009, p.distance - eye_.radius)) *
         (1 - smoothstep(10 * degree, 48 * degree, f.lower - p.elevation));
}

Vector3d LidControl::gaze(const LidMotion& motion) const {
  return Eigen::AngleAxisd(sign_ * motion.bulge_side * degree, Vector3d::UnitY()) *
         (Eigen::AngleAxisd(-motion.bulge_up * degree, Vector3d::UnitX()) * Vector3d::UnitZ());
}

Vector3d LidControl::carried(const Vector3d& X, const LidMotion& motion) const {
  const Place p = place(X);
  const Fissure from = fissure(p.across), to = moved(from, motion);
  const double aside = std::max({0.0, -p.across, p.across - 1}) * length_;
  double follow = 1 - smoothstep(0, 0.006, aside), turn = 0, distance = p.distance;
  const auto between = [&](double a, double b, double a_to, double b_to) {
    const double t = b > a ? (p.elevation - a) / (b - a) : 0.5;
    return a_to + t * (b_to - a_to) - p.elevation;
  };
  if (p.elevation >= from.upper) {
    const double beyond = p.elevation - from.upper, room = from.orbit - from.upper;
    const bool closes = to.upper < from.upper;
    // Closing unfolds the skin below the brow; opening takes the brow's surroundings along.
    follow *= closes ? 1 - unfold(std::min(tarsus, 0.3 * room), room, beyond)
                     : 1 - smoothstep(6 * degree, 66 * degree, beyond);
    turn = to.upper - from.upper;
    // The fold above the eye unrolls and lies flat on the globe.
    const double flat = std::min(distance, sample(upper_height_, p.across) + 0.0003);
    if (closes) distance += smoothstep(0, 25 * degree, follow * -turn) * (flat - distance);
  } else if (p.elevation <= from.lower) {
    follow *= 1 - smoothstep(6 * degree, cheek_reach, from.lower - p.elevation);
    turn = to.lower - from.lower;
    const double flat = std::min(distance, sample(lower_height_, p.across) + 0.0003);
    if (turn > 0) distance += smoothstep(0, 25 * degree, follow * turn) * (flat - distance);
  } else if (p.elevation > from.upper_inner) {
    turn = between(from.upper_inner, from.upper, to.upper_inner, to.upper);
  } else if (p.elevation < from.lower_inner) {
    turn = between(from.lower, from.lower_inner, to.lower, to.lower_inner);
  } else {
    turn = between(from.lower_inner, from.upper_inner, to.lower_inner, to.upper_inner);
  }
  // Turning about axis_ by a positive angle lifts when axis_ x ahead_ points up.
  const double lift = axis_.cross(ahead_).dot(up_) > 0 ? 1 : -1;
  const Vector3d before = (X - eye_.centre).normalized();
  const Eigen::AngleAxisd sideways(sign_ * motion.sideways * follow * degree, Vector3d::UnitY());
  const Vector3d direction = sideways * (Eigen::AngleAxisd(lift * follow * turn, axis_) * before);
  distance += eye_.bulge(direction, gaze(motion)) - eye_.bulge(before, Vector3d::UnitZ());
  return eye_.centre + distance * direction;
}

std::vector<Handle> LidControl::handles(const LidMotion& motion) const {
  std::vector<Handle> result;
  for (const auto& [vertex, rest] : led_) result.push_back({vertex, carried(rest, motion), 8 * lead(place(rest))});
  const double hold = 4 * smoothstep(0, 0.3, motion.upper);
  if (hold > 0)
    for (const auto& [vertex, rest] : brow_) result.push_back({vertex, rest, hold});
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

double LidControl::exact(const Vector3d& X) const {
  const Vector3d d = X - eye_.centre;
  const double distance = d.norm();
  if (distance > eye_.radius + 0.006 || d.dot(ahead_) < 0.15 * eye_.radius) return 0;
  const Place p = place(X);
  const Fissure f = fissure(p.across);
  const double beyond = std::max({0.0, p.elevation - f.upper, f.lower - p.elevation});
  // The lining that lies on the eyeball goes with the lids as deep as they reach, the skin outside only at the edge.
  const double depth = distance < eye_.radius + 0.0012 ? 40 * degree : 8 * degree;
  return lead(p) * (1 - smoothstep(0.3 * depth, depth, beyond));
}

void LidControl::mark_settled(const MatrixX3d& rest, std::vector<char>& marks) const {
  for (Eigen::Index v = 0; v < rest.rows(); ++v)
    if (exact(rest.row(v)) > 0.9) marks[static_cast<std::size_t>(v)] = 1;
}

void LidControl::settle(const MatrixX3d& rest, MatrixX3d& displacement, const LidMotion& motion) const {
  const Vector3d look = gaze(motion);
  for (Eigen::Index v = 0; v < rest.rows(); ++v) {
    const Vector3d X = rest.row(v);
    const double distance = (X - eye_.centre).norm();
    if (distance > eye_.radius + 0.006) continue;
    Vector3d x = X + displacement.row(v).transpose();
    if (const double share = exact(X); share > 0) x += share * (carried(X, motion) - x);
    if (distance < eye_.radius + 0.002) x = outside(x, distance, look);
    displacement.row(v) = (x - X).transpose();
  }
}

}  // namespace phiz
