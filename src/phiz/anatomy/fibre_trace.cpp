// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "phiz/anatomy/fibre_field.h"
#include "phiz/anatomy/fibre_state.h"

namespace phiz {

namespace {

constexpr double least_apart = 0.002;  // metres between seeds
constexpr double longest = 0.4;        // metres
constexpr double step_share = 0.5;     // step of the integration / edge of a voxel

MatrixX3d resampled(const std::vector<Vector3d>& line, int points) {
  std::vector<double> arc{0};
  for (std::size_t i = 1; i < line.size(); ++i) arc.push_back(arc.back() + (line[i] - line[i - 1]).norm());
  MatrixX3d result(points, 3);
  std::size_t piece = 0;
  for (int i = 0; i < points; ++i) {
    const double s = arc.back() * i / (points - 1);
    while (piece + 2 < line.size() && arc[piece + 1] < s) ++piece;
    const double span = arc[piece + 1] - arc[piece], t = span > 0 ? std::min(1.0, (s - arc[piece]) / span) : 0;
    result.row(i) = ((1 - t) * line[piece] + t * line[piece + 1]).transpose();
  }
  return result;
}

/// Each next seed is the candidate farthest from those before.
std::vector<Vector3d> spread_out(const std::vector<Vector3d>& candidates, int fewest, int most) {
  std::vector<Vector3d> seeds;
  if (candidates.empty()) return seeds;
  Vector3d centre = Vector3d::Zero();
  for (const Vector3d& c : candidates) centre += c / static_cast<double>(candidates.size());
  std::vector<double> apart(candidates.size());
  for (std::size_t i = 0; i < apart.size(); ++i) apart[i] = (candidates[i] - centre).norm();
  while (static_cast<int>(seeds.size()) < most) {
    const auto best = std::max_element(apart.begin(), apart.end());
    if (!seeds.empty() && static_cast<int>(seeds.size()) >= fewest && *best < least_apart) break;
    if (!seeds.empty() && *best <= 0) break;
    const Vector3d seed = candidates[static_cast<std::size_t>(best - apart.begin())];
    for (std::size_t i = 0; i < apart.size(); ++i)
      apart[i] = seeds.empty() ? (candidates[i] - seed).norm() : std::min(apart[i], (candidates[i] - seed).norm());
    seeds.push_back(seed);
  }
  return seeds;
}

/// The angle of p round the axis of a ring, seen from the half-plane through `start`: 0 there, growing to 2 pi.
double angle_from(const Vector3d& p, const Vector3d& start, const Vector3d& centre, const Vector3d& axis) {
  const Vector3d first = axis.cross(start - centre).cross(axis).normalized(), second = axis.normalized().cross(first);
  const double angle = std::atan2((p - centre).dot(second), (p - centre).dot(first));
  return angle < 0 ? angle + 2 * std::numbers::pi : angle;
}

}  // namespace

std::vector<Vector3d> FibreField::State::seed_candidates(double band) const {
  // Half way between the ends; in rings the half-plane where they are cut, on the side of the angle's zero.
  std::vector<Vector3d> candidates;
  Vector3d start = Vector3d::Zero();
  if (ring)  // the side on which the ring reaches farthest from its axis
    for (std::size_t r = 0; r < flow.voxels.size(); ++r) {
      const Vector3d out = grid().centre(flow.voxels[r]) - ring_centre;
      if (flow.solved(static_cast<int>(r)) && ring_axis.cross(out).norm() > ring_axis.cross(start).norm()) start = out;
    }
  const Vector3d side = ring_axis.cross(start).normalized();
  for (std::size_t r = 0; r < flow.voxels.size(); ++r) {
    if (!flow.solved(static_cast<int>(r)) || !voxels.inside()[static_cast<std::size_t>(flow.voxels[r])]) continue;
    const Vector3d p = grid().centre(flow.voxels[r]);
    const bool middle =
        ring ? std::abs(side.dot(p - ring_centre)) < 0.75 * grid().spacing && (p - ring_centre).dot(start) > 0
             : std::abs(flow.value[static_cast<Eigen::Index>(r)] - 0.5) < band;
    if (middle) candidates.push_back(p);
  }
  return candidates;
}

std::optional<Vector3d> FibreField::State::held_inside(const Vector3d& p) const {
  if (row_at(p) >= 0) return p;
  Vector3d sum = Vector3d::Zero();
  int count = 0;
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        const Vector3d q = p + grid().spacing * Vector3d(x, y, z);
        const int r = row_at(q);
        if (r < 0) continue;
        sum += grid().centre(flow.voxels[static_cast<std::size_t>(r)]);
        ++count;
      }
  if (count == 0) return std::nullopt;
  const Vector3d middle = sum / count;
  for (const double share : {0.34, 0.67, 1.0}) {
    const Vector3d q = p + share * (middle - p);
    if (row_at(q) >= 0) return q;
  }
  return std::nullopt;
}

std::vector<Vector3d> FibreField::State::walk(const FibreField& field, const Vector3d& p, int way) const {
  std::vector<Vector3d> line{p};
  const double step = step_share * grid().spacing;
  Vector3d heading = way * field.direction(p);
  bool half_round = false;
  for (double length = 0; length < longest; length += step) {
    const Vector3d x = line.back();
    const Vector3d half = x + 0.5 * step * heading;
    const Vector3d along = way * field.direction(half);
    if (along.dot(heading) < 0) break;  // the flow turns back: an end
    const std::optional<Vector3d> next = held_inside(x + step * along);
    if (!next || (*next - x).dot(along) < 0.1 * step) break;
    line.push_back(*next);
    heading = way * field.direction(*next);
    if (!ring) continue;
    const double angle = angle_from(*next, p, ring_centre, ring_axis);
    half_round = half_round || (angle > 0.9 * std::numbers::pi && angle < 1.5 * std::numbers::pi);
    if (half_round && angle < 0.5 * std::numbers::pi) break;
  }
  return line;
}

std::vector<MatrixX3d> FibreField::trace(int fewest, int most, int points) const {
  const State& s = *state_;
  std::vector<Vector3d> candidates;
  for (double band = 0.1; band < 0.6 && static_cast<int>(candidates.size()) < fewest; band += 0.1)
    candidates = s.seed_candidates(band);
  std::vector<MatrixX3d> fibres;
  for (const Vector3d& seed : spread_out(candidates, fewest, most)) {
    std::vector<Vector3d> line = s.walk(*this, seed, 1);
    if (s.ring) {
      // One round; what it misses its beginning by is spread over its length.
      const Vector3d gap = line.front() - line.back();
      const auto last = static_cast<double>(line.size() - 1);
      for (std::size_t i = 0; i < line.size() && last > 0; ++i) line[i] += (static_cast<double>(i) / last) * gap;
    } else {
      std::vector<Vector3d> back = s.walk(*this, seed, -1);
      std::reverse(back.begin(), back.end());
      back.insert(back.end(), line.begin() + 1, line.end());
      line = std::move(back);
    }
    if (line.size() >= 3) fibres.push_back(resampled(line, points));
  }
  return fibres;
}

}  // namespace phiz
