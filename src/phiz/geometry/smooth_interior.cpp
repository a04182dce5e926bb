// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "phiz/core/random.h"
#include "phiz/geometry/tet_complex.h"
#include "phiz/geometry/tetrahedralise.h"

namespace phiz {

namespace {

/// The tets round one vertex, with that vertex replaced on trial.
class Star {
 public:
  Star(const TetMesh& mesh, const std::vector<int>& tets, int centre) : mesh_(mesh), tets_(tets), centre_(centre) {}

  struct Quality {
    double worst = std::numeric_limits<double>::infinity();  ///< smallest radius ratio
    double cost = 0;                                         ///< sum of ratio^-4: the worst tets count most, all count
    bool is_better_than(const Quality& other) const { return cost < other.cost && worst >= other.worst; }
  };

  /// Stops early, with an infinite cost, once the star is no better than `limit`.
  Quality quality(const Vector3d& p, const Quality& limit) const {
    Quality q;
    for (const int t : tets_) {
      const auto corner = corners(t, p);
      const double ratio = radius_ratio(corner[0], corner[1], corner[2], corner[3]);
      q.worst = std::min(q.worst, ratio);
      q.cost += 1 / (ratio * ratio * ratio * ratio);
      if (!(ratio > 0) || !q.is_better_than(limit)) return {q.worst, std::numeric_limits<double>::infinity()};
    }
    return q;
  }

  Quality quality(const Vector3d& p) const {
    return quality(p, {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()});
  }

  /// The worst sine of a dihedral angle.
  double sine(const Vector3d& p) const {
    double worst = 1;
    for (const int t : tets_) {
      const auto corner = corners(t, p);
      worst = std::min(worst, least_sine(corner[0], corner[1], corner[2], corner[3]));
    }
    return worst;
  }

  Vector3d mean_of_neighbours() const {
    Vector3d sum = Vector3d::Zero();
    double count = 0;
    for (const int t : tets_)
      for (int k = 0; k < 4; ++k)
        if (mesh_.T(t, k) != centre_) {
          sum += mesh_.V.row(mesh_.T(t, k)).transpose();
          count += 1;
        }
    return sum / count;
  }

  double shortest_spoke(const Vector3d& p) const {
    double squared = std::numeric_limits<double>::infinity();
    for (const int t : tets_)
      for (int k = 0; k < 4; ++k)
        if (mesh_.T(t, k) != centre_)
          squared = std::min(squared, (mesh_.V.row(mesh_.T(t, k)).transpose() - p).squaredNorm());
    return std::sqrt(squared);
  }

 private:
  std::array<Vector3d, 4> corners(int t, const Vector3d& p) const {
    std::array<Vector3d, 4> corner;
    for (int k = 0; k < 4; ++k)
      corner[static_cast<std::size_t>(k)] = mesh_.T(t, k) == centre_ ? p : Vector3d(mesh_.V.row(mesh_.T(t, k)));
    return corner;
  }

  const TetMesh& mesh_;
  const std::vector<int>& tets_;
  int centre_;
};

constexpr double good_enough = 0.5;  // stars whose worst tet is this good are left alone

}  // namespace

int smooth_interior(TetMesh& mesh, const std::vector<char>& fixed, int passes, double kept_angle) {
  const double kept_sine = std::sin(kept_angle * std::numbers::pi / 180);
  std::vector<std::vector<int>> tets_of(static_cast<std::size_t>(mesh.V.rows()));
  for (int t = 0; t < mesh.T.rows(); ++t)
    for (int k = 0; k < 4; ++k) tets_of[static_cast<std::size_t>(mesh.T(t, k))].push_back(t);

  int moves = 0;
  for (int pass = 0; pass < passes; ++pass) {
    int moved = 0;
    for (int v = 0; v < mesh.V.rows(); ++v) {
      if (fixed[static_cast<std::size_t>(v)] || tets_of[static_cast<std::size_t>(v)].empty()) continue;
      const Star star(mesh, tets_of[static_cast<std::size_t>(v)], v);
      const Vector3d start = mesh.V.row(v);
      Vector3d best = start;
      const Star::Quality before = star.quality(start);
      if (before.worst > good_enough) continue;
      Star::Quality reached = before;
      const double floor = kept_angle > 0 ? std::min(kept_sine, star.sine(start)) : 0;
      const auto attempt = [&](const Vector3d& p) {
        const Star::Quality q = star.quality(p, reached);
        if (!q.is_better_than(reached) || (floor > 0 && star.sine(p) < floor)) return false;
        reached = q;
        best = p;
        return true;
      };
      const Vector3d mean = star.mean_of_neighbours();
      for (const double share : {1.0, 0.5, 0.25}) attempt(start + share * (mean - start));
      // Random directions with shrinking steps: the objective has kinks where the worst tet changes.
      Random random(static_cast<std::uint64_t>(v), static_cast<std::uint64_t>(pass));
      double step = 0.3 * star.shortest_spoke(best);
      for (int trial = 0; trial < 24; ++trial) {
        const Vector3d direction(random.normal(), random.normal(), random.normal());
        const Vector3d move = step * direction.normalized();
        if (!attempt(best + move) && !attempt(best - move)) step *= 0.8;
      }
      if (reached.is_better_than(before)) {
        mesh.V.row(v) = best;
        ++moved;
      }
    }
    moves += moved;
    if (moved == 0) break;
  }
  return moves;
}

}  // namespace phiz
