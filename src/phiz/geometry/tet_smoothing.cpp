// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "phiz/geometry/tet_operations.h"

namespace phiz {

namespace {

struct Sample {
  double quality;
  Vector3d gradient;
};

/// The tets round one vertex with that vertex on trial.
class Star {
 public:
  Star(const TetComplex& complex, int v) : weight_(complex.weight()) {
    for (const int t : complex.tets_of(v)) {
      const Corners& corners = complex.tet(t).v;
      const int k = corner_of(corners, v);
      // The vertex first, the opposite face turned so that the tet stays positive.
      opposite_.push_back({complex.x(corners[static_cast<std::size_t>(face_corners[k][0])]),
                           complex.x(corners[static_cast<std::size_t>(face_corners[k][1])]),
                           complex.x(corners[static_cast<std::size_t>(face_corners[k][2])])});
    }
  }

  /// Worst quality; stops early once it is no better than `limit`.
  double worst(const Vector3d& p, double limit) const {
    double q = infinite;
    for (const auto& f : opposite_) {
      q = std::min(q, tet_shape(p, f[0], f[1], f[2], weight_));
      if (!(q > limit)) break;
    }
    return q;
  }

  std::vector<Sample> samples(const Vector3d& p) const {
    std::vector<Sample> all;
    for (const auto& f : opposite_) {
      Sample s;
      s.quality = tet_shape(p, f[0], f[1], f[2], weight_, s.gradient);
      all.push_back(s);
    }
    return all;
  }

  double shortest_spoke(const Vector3d& p) const {
    double squared = infinite;
    for (const auto& f : opposite_)
      for (const Vector3d& corner : f) squared = std::min(squared, (corner - p).squaredNorm());
    return std::sqrt(squared);
  }

 private:
  double weight_;
  std::vector<std::array<Vector3d, 3>> opposite_;
};

/// The point nearest to the origin of the hull of some points: the nearest point of the right one of their corners,
/// edges and triangles. Zero when the origin is inside.
Vector3d nearest_to_origin(const std::vector<Vector3d>& g) {
  const auto is_answer = [&g](const Vector3d& p) {
    const double squared = p.squaredNorm();
    return std::all_of(g.begin(), g.end(), [&](const Vector3d& q) { return q.dot(p) >= squared * (1 - 1e-9); });
  };
  const std::size_t n = g.size();
  for (std::size_t i = 0; i < n; ++i)
    if (is_answer(g[i])) return g[i];
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j) {
      const Vector3d along = g[j] - g[i];
      const double share = -g[i].dot(along) / along.squaredNorm();
      if (!(share > 0 && share < 1)) continue;
      const Vector3d p = g[i] + share * along;
      if (is_answer(p)) return p;
    }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j)
      for (std::size_t k = j + 1; k < n; ++k) {
        const Vector3d normal = (g[j] - g[i]).cross(g[k] - g[i]);
        if (!(normal.squaredNorm() > 0)) continue;
        const Vector3d p = normal.dot(g[i]) / normal.squaredNorm() * normal;
        // Within the triangle when each corner's weight is positive.
        if (normal.dot((g[j] - p).cross(g[k] - p)) > 0 && normal.dot((g[k] - p).cross(g[i] - p)) > 0 &&
            normal.dot((g[i] - p).cross(g[j] - p)) > 0 && is_answer(p))
          return p;
      }
  return Vector3d::Zero();
}

/// Direction in which all tets within `margin` of the worst get better; zero when there is none.
Vector3d ascent(std::vector<Sample>& samples, double margin) {
  constexpr std::size_t most_active = 9;
  std::vector<Vector3d> active;
  for (const Sample& s : samples) {
    if (s.quality > samples.front().quality + margin || active.size() == most_active) break;
    active.push_back(s.gradient);
  }
  return nearest_to_origin(active);
}

}  // namespace

bool smooth_vertex(TetComplex& complex, int v) {
  if (!complex.may_move(v) || complex.tets_of(v).empty()) return false;
  constexpr int steps = 12, halvings = 7;
  const Star star(complex, v);
  Vector3d x = complex.x(v);
  const double before = complex.worst(complex.tets_of(v));
  double reached = before;
  for (int step = 0; step < steps; ++step) {
    std::vector<Sample> samples = star.samples(x);
    std::stable_sort(samples.begin(), samples.end(),
                     [](const Sample& a, const Sample& b) { return a.quality < b.quality; });
    const double at_start = reached, spoke = star.shortest_spoke(x);
    for (const double margin : {0.002, 0.01, 0.05}) {
      const Vector3d direction = ascent(samples, margin);
      const double slope = direction.norm();
      if (!(slope * spoke > 1e-6)) continue;
      // As far as the tets not considered allow to first order, or a good part of the star.
      double length = 0.7 * spoke;
      for (const Sample& s : samples) {
        const double along = s.gradient.dot(direction) / slope;
        if (s.quality > reached + margin && along < slope)
          length = std::min(length, std::max(0.02 * spoke, (s.quality - reached) / (slope - along)));
      }
      for (int k = 0; k < halvings; ++k, length *= 0.5) {
        const Vector3d p = complex.allowed(v, x + length / slope * direction);
        const double q = star.worst(p, reached);
        if (q > reached) {
          reached = q;
          x = p;
          break;
        }
      }
      if (reached > at_start) break;
    }
    if (reached < at_start + 0.02 * std::abs(at_start)) break;
  }
  if (!(reached > before + least_gain)) return false;
  complex.move(v, x);
  return true;
}

}  // namespace phiz
