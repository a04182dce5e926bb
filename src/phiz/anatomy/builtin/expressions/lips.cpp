// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/expressions/lips.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "phiz/anatomy/builtin/ease.h"
#include "phiz/anatomy/builtin/expressions/skin.h"

namespace phiz {
namespace {

constexpr int lip_stations = 65;
constexpr double meeting_share = 0.36;  ///< of the jaw's way down, at which sealed lips meet
constexpr double retreat_share = 0.15;  ///< of its way back: the upper teeth hold them in front

/// Through the values at the centre, halfway and the corner; even and smooth across the centre, but for `wide` and
/// `turn`, which are odd: positive to the person's left.
LipSection section(const LipMotion& m, double along) {
  const double q = std::min(1.0, along * along), a = (1 - q) * (0.25 - q) / 0.25, b = q * (1 - q) / 0.1875,
               c = q * (q - 0.25) / 0.75;
  const auto even = [&](double LipSection::*field) {
    return a * m.centre.*field + b * m.middle.*field + c * m.corner.*field;
  };
  const auto odd = [&](double LipSection::*field) {
    const double near = (m.middle.*field - 0.125 * m.corner.*field) / 0.375, far = m.corner.*field - near;
    return std::clamp(along, -1.0, 1.0) * (near + far * q);
  };
  return {even(&LipSection::up),  even(&LipSection::out),  odd(&LipSection::wide), even(&LipSection::left),
          odd(&LipSection::turn), even(&LipSection::roll), even(&LipSection::thin)};
}

/// A curve from corner to corner resampled at `lip_stations` places, even in x, right corner first.
MatrixX3d by_width(const MatrixX3d& curve) {
  MatrixX3d rightward = curve;
  if (curve(0, 0) > curve(curve.rows() - 1, 0)) rightward = curve.colwise().reverse();
  MatrixX3d result(lip_stations, 3);
  const Eigen::Index last = rightward.rows() - 1;
  Eigen::Index i = 0;
  for (int k = 0; k < lip_stations; ++k) {
    const double x = rightward(0, 0) + (rightward(last, 0) - rightward(0, 0)) * k / (lip_stations - 1);
    while (i + 1 < last && rightward(i + 1, 0) < x) ++i;
    const double span = rightward(i + 1, 0) - rightward(i, 0);
    const double t = span > 0 ? std::clamp((x - rightward(i, 0)) / span, 0.0, 1.0) : 0;
    result.row(k) = (1 - t) * rightward.row(i) + t * rightward.row(i + 1);
  }
  return result;
}

}  // namespace

LipControl::LipControl(const HeadTemplate& head) {
  const MatrixX3d upper = by_width(skin_curve(head, "loop:upperLipLine"));
  const MatrixX3d lower = by_width(skin_curve(head, "loop:lowerLipLine"));
  line_ = 0.5 * (upper + lower);
  nearness_.setZero(head.volume.V.rows());
  const std::vector<char> in_upper = simulation_mask(head, {"upperLip", "upperLipInner"});
  const std::vector<char> in_lower = simulation_mask(head, {"lowerLip", "lowerLipInner"});
  const std::vector<char> red = simulation_mask(head, {"upperLip", "lowerLip"});
  const std::vector<char> lining = simulation_mask(head, {"upperLipInner", "lowerLipInner", "mouthBag"});
  std::vector<int> red_vertices;
  for (std::size_t i = 0; i < red.size(); ++i)
    if (red[i]) red_vertices.push_back(head.skin_vertices[static_cast<Eigen::Index>(i)]);
  const MatrixX3d red_points = head.volume.V(red_vertices, Eigen::all);
  const double half = 0.5 * (line_(lip_stations - 1, 0) - line_(0, 0));
  const double centre = 0.5 * (line_(lip_stations - 1, 0) + line_(0, 0));
  for (Eigen::Index i = 0; i < head.skin_vertices.size(); ++i) {
    const int v = head.skin_vertices[i];
    const Vector3d X = head.volume.V.row(v).transpose();
    const double distance = std::sqrt((line_.rowwise() - X.transpose()).rowwise().squaredNorm().minCoeff());
    nearness_[v] = 1 - smoothstep(0.003, 0.008, distance);
    const auto k = static_cast<std::size_t>(i);
    const double along = std::clamp((X.x() - centre) / half, -1.2, 1.2);
    // Lining that slides with a corner; the crease behind it counts as part of both lips.
    const bool inside = lining[k] || (in_upper[k] && in_lower[k] && X.z() < frame_at(along).middle.z() - 0.001);
    const double from_corner =
        std::min((X.transpose() - line_.row(0)).norm(), (X.transpose() - line_.row(lip_stations - 1)).norm());
    LipVertex entry{v, along, std::pow(1 - smoothstep(0.002, 0.016, distance), 2), 0, 0, 0, 0, true, X};
    entry.follow = 1 - smoothstep(0.002, 0.024, distance);
    if (inside) {
      entry.slide_grip = 1 - smoothstep(0.012, 0.036, from_corner);
      entry.slide_follow = 1 - smoothstep(0, 0.042, distance);
    }
    if (std::max(entry.grip, entry.slide_grip) <= 0 || head.carrier[v] != static_cast<int>(Carrier::flesh)) continue;
    entry.lip =
        red[k] ? 1
               : 1 - smoothstep(0, 0.007,
                                std::sqrt((red_points.rowwise() - X.transpose()).rowwise().squaredNorm().minCoeff()));
    if (X.z() < frame_at(entry.along).middle.z()) entry.lip *= 1 - smoothstep(0.007, 0.015, distance);
    const Frame frame = frame_at(entry.along);
    entry.upper = in_upper[k] || (!in_lower[k] && (X - frame.middle).dot(frame.up) > 0);
    vertices_.push_back(entry);
  }
}

LipControl::Frame LipControl::frame_at(double along) const {
  const double at = (std::clamp(along, -1.0, 1.0) + 1) / 2 * (lip_stations - 1);
  const auto i = std::min(static_cast<Eigen::Index>(at), Eigen::Index{lip_stations - 2});
  const double t = at - static_cast<double>(i);
  Frame f;
  f.middle = ((1 - t) * line_.row(i) + t * line_.row(i + 1)).transpose();
  const Eigen::Index a = std::max<Eigen::Index>(i - 3, 0), b = std::min<Eigen::Index>(i + 4, lip_stations - 1);
  f.along = (line_.row(b) - line_.row(a)).transpose().normalized();
  f.out = f.along.cross(Vector3d::UnitY()).normalized();
  if (f.out.z() < 0) f.out = -f.out;
  f.up = f.out.cross(f.along).normalized();
  if (f.up.y() < 0) f.up = -f.up;
  return f;
}

Handle LipControl::sealed(const LipVertex& v, const Eigen::Isometry3d& jaw) const {
  const Vector3d middle = frame_at(v.along).middle;
  const Vector3d way = jaw * middle - middle;
  const Vector3d meeting = middle + Vector3d(meeting_share * way.x(), meeting_share * way.y(), retreat_share * way.z());
  const Eigen::AngleAxisd opening(jaw.rotation());
  const Eigen::AngleAxisd tilt((v.upper ? meeting_share : 0.7) * opening.angle(), opening.axis());
  return {v.vertex, meeting + tilt * (v.rest - middle), 6 * v.grip};
}

std::vector<Handle> LipControl::handles(const ExpressionRecipe& recipe, const Eigen::Isometry3d& jaw) const {
  std::vector<Handle> result;
  const double mm = 1e-3;
  for (const LipVertex& v : vertices_) {
    if (recipe.sealed) {
      result.push_back(sealed(v, jaw));
      continue;
    }
    const LipMotion& motion = v.upper ? recipe.upper_lip : recipe.lower_lip;
    const double side = recipe.paired && !recipe.both_halves ? smoothstep(-0.3, 0.35, v.along) : 1;
    const double q = std::min(1.0, v.along * v.along);
    const bool slides = motion.corner.out <= -5 && v.slide_grip > v.grip;
    const double follow = slides ? v.slide_follow : v.follow;
    double weight = motion.hold * (slides ? v.slide_grip : v.grip) * side;
    if (recipe.open > 0) weight *= 1 - 0.8 * q;  // the corners are freer on an open jaw
    if (weight <= 0) continue;
    const LipSection m = section(motion, v.along);
    const Frame f = frame_at(v.along);
    const Vector3d axis_point = f.middle - 4 * mm * f.out + (v.upper ? 3 : -3) * mm * f.up;
    const double roll = (v.upper ? -1 : 1) * side * v.lip * m.roll * std::numbers::pi / 180;
    const Vector3d thinned = v.rest - side * v.lip * m.thin * (v.rest - f.middle).dot(f.up) * f.up;
    const Vector3d rolled = axis_point + Eigen::AngleAxisd(roll, f.along) * (thinned - axis_point);
    const Vector3d forward = (f.out + 2 * Vector3d::UnitZ()).normalized();
    const Vector3d way = m.up * f.up + (m.out - m.turn) * forward + (m.wide + m.left) * Vector3d::UnitX();
    const Vector3d moved = rolled + side * follow * mm * way;
    // The lower lip rides on the jaw, less so towards the corners.
    const double shared = 0.5 - 0.5 * std::sqrt(1 - q);  // the opening is round
    const double ride = v.upper ? shared : 1 - shared;
    result.push_back({v.vertex, (1 - ride) * moved + ride * (jaw * moved), weight});
  }
  return result;
}

}  // namespace phiz
