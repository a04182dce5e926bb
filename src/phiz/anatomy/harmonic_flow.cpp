// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/harmonic_flow.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "phiz/numerics/cholesky.h"

namespace phiz {

namespace {

constexpr double end_depth = 0.0012;      // metres: how deep the ends reach into the muscle
constexpr double deepest_end = 0.004;     // where the muscle is thick or the points of an end are far apart
constexpr double longest_end = 0.25;      // of the distance between origin and insertion
constexpr double farthest_end = 0.01;     // metres: points of an end farther from the muscle do not count
constexpr double smallest_turning = 0.3;  // of the mean flow of a closed ring: less is an open one
constexpr int smoothing_passes = 3;       // evens out the steps of slanted sides

using Rows = std::vector<char>;  // one flag per row

HarmonicFlow start(const VoxelGrid& grid, const VoxelFlags& domain) {
  HarmonicFlow flow;
  flow.row.assign(domain.size(), -1);
  for (std::ptrdiff_t voxel = 0; voxel < grid.count(); ++voxel) {
    if (!domain[static_cast<std::size_t>(voxel)]) continue;
    flow.row[static_cast<std::size_t>(voxel)] = static_cast<int>(flow.voxels.size());
    flow.voxels.push_back(voxel);
  }
  const auto n = static_cast<Eigen::Index>(flow.voxels.size());
  flow.value = VectorXd::Zero(n);
  flow.direction = MatrixX3d::Zero(n, 3);
  return flow;
}

/// Calls visit(axis, way, row of the neighbour) for the neighbours of row r in the domain.
template <class Visit>
void each_neighbour(const VoxelGrid& grid, const HarmonicFlow& flow, Eigen::Index r, Visit&& visit) {
  for (int axis = 0; axis < 3; ++axis)
    for (const int way : {-1, 1}) {
      const std::ptrdiff_t next = flow.voxels[static_cast<std::size_t>(r)] + way * grid.stride(axis);
      const int other = flow.row[static_cast<std::size_t>(next)];
      if (other >= 0) visit(axis, way, other);
    }
}

/// Half the usual distance of a point to its nearest neighbour.
double half_spacing(const MatrixX3d& points) {
  constexpr Eigen::Index most = 400;
  const Eigen::Index step = std::max<Eigen::Index>(1, points.rows() / most);
  std::vector<double> nearest;
  for (Eigen::Index i = 0; i < points.rows(); i += step) {
    double least = std::numeric_limits<double>::infinity();
    for (Eigen::Index k = 0; k < points.rows(); ++k)
      if (k != i) least = std::min(least, (points.row(i) - points.row(k)).squaredNorm());
    nearest.push_back(std::sqrt(least));
  }
  std::nth_element(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(nearest.size() / 2), nearest.end());
  return 0.5 * nearest[nearest.size() / 2];
}

/// How deep below the surface the voxels round `seeds` lie at most, metres: half the thickness of the muscle there.
double depth_round(const VoxelGrid& grid, const HarmonicFlow& flow, const VoxelFlags& seeds) {
  const VoxelFlags round = dilate(grid, seeds, deepest_end);
  std::vector<int> layer(flow.voxels.size(), 0);  // 1 at the surface
  std::vector<int> front;
  for (std::size_t r = 0; r < layer.size(); ++r) {
    int count = 0;
    each_neighbour(grid, flow, static_cast<Eigen::Index>(r), [&count](int, int, int) { ++count; });
    if (count < 6) layer[r] = 1, front.push_back(static_cast<int>(r));
  }
  int deepest = 0;
  for (std::size_t next = 0; next < front.size(); ++next) {
    const auto r = static_cast<std::size_t>(front[next]);
    if (round[static_cast<std::size_t>(flow.voxels[r])]) deepest = layer[r];
    each_neighbour(grid, flow, front[next], [&](int, int, int other) {
      int& its = layer[static_cast<std::size_t>(other)];
      if (its == 0) its = layer[r] + 1, front.push_back(other);
    });
  }
  return (deepest - 0.5) * grid.spacing;
}

/// From the points of one end to the nearest ones of the other, on average: halves of a muscle count for themselves.
double mean_distance(const MatrixX3d& from, const MatrixX3d& to) {
  double sum = 0;
  for (Eigen::Index i = 0; i < from.rows(); ++i)
    sum += std::sqrt((to.rowwise() - from.row(i)).rowwise().squaredNorm().minCoeff());
  return sum / static_cast<double>(from.rows());
}

/// The rows round the points of an end: those nearest to each point, and what lies round these, as far as the muscle is
/// thick there, so that the end goes across all of it;
/// but not beyond `limit` metres.
Rows rows_of_end(const VoxelGrid& grid, const HarmonicFlow& flow, const MatrixX3d& points, double limit) {
  VoxelFlags seeds(flow.row.size(), 0);
  const int farthest = static_cast<int>(farthest_end / grid.spacing);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Vector3d p = points.row(i);
    const Eigen::Vector3i middle = ((p - grid.low) / grid.spacing).array().floor().cast<int>();
    double least = std::numeric_limits<double>::infinity();
    std::ptrdiff_t nearest = -1;
    for (int shell = 0; shell <= farthest && (nearest < 0 || shell * grid.spacing < std::sqrt(least)); ++shell) {
      const Eigen::Vector3i low = (middle.array() - shell).max(0);
      const Eigen::Vector3i high = (middle.array() + shell).min(grid.size.array() - 1);
      for (int z = low.z(); z <= high.z(); ++z)
        for (int y = low.y(); y <= high.y(); ++y)
          for (int x = low.x(); x <= high.x(); ++x) {
            if ((Eigen::Vector3i(x, y, z) - middle).cwiseAbs().maxCoeff() != shell) continue;
            const std::ptrdiff_t voxel = x + y * grid.stride(1) + z * grid.stride(2);
            if (flow.row[static_cast<std::size_t>(voxel)] < 0) continue;
            const double d = (grid.centre(voxel) - p).squaredNorm();
            if (d < least) least = d, nearest = voxel;
          }
    }
    if (nearest >= 0) seeds[static_cast<std::size_t>(nearest)] = 1;
  }
  const double spread = points.rows() > 1 ? std::min(half_spacing(points), deepest_end) : 0;
  const double depth = std::min(depth_round(grid, flow, seeds), deepest_end);
  const double reach = std::min(limit, std::max({end_depth, spread, depth}));
  const VoxelFlags grown = dilate(grid, seeds, std::max(reach, 1.01 * grid.spacing));
  Rows rows(flow.voxels.size());
  for (std::size_t r = 0; r < rows.size(); ++r) rows[r] = grown[static_cast<std::size_t>(flow.voxels[r])];
  return rows;
}

/// Gives the rows in `pieces` that have no direction that of their neighbours, step by step.
void spread_directions(const VoxelGrid& grid, HarmonicFlow& flow, const Rows& wanted) {
  std::vector<int> empty;
  for (std::size_t r = 0; r < wanted.size(); ++r)
    if (wanted[r] && !flow.solved(static_cast<int>(r))) empty.push_back(static_cast<int>(r));
  while (!empty.empty()) {
    std::vector<std::pair<int, Vector3d>> found;
    std::vector<int> left;
    for (const int r : empty) {
      Vector3d sum = Vector3d::Zero();
      each_neighbour(grid, flow, r, [&](int, int, int other) { sum += flow.direction.row(other).transpose(); });
      if (sum.norm() > 1e-6)
        found.emplace_back(r, sum.normalized());
      else
        left.push_back(r);
    }
    if (found.empty()) return;
    for (const auto& [r, d] : found) flow.direction.row(r) = d.transpose();
    empty = std::move(left);
  }
}

/// Turns gradients into unit vectors: smoothed over neighbours; where nearly nothing flows, as inside of the ends,
/// those of the surroundings.
void normalise(const VoxelGrid& grid, HarmonicFlow& flow, const Rows& solved) {
  for (int pass = 0; pass < smoothing_passes; ++pass) {
    const MatrixX3d before = flow.direction;
    for (Eigen::Index r = 0; r < before.rows(); ++r) {
      Vector3d sum = 2 * before.row(r).transpose();
      int count = 2;
      each_neighbour(grid, flow, r, [&](int, int, int other) { sum += before.row(other).transpose(), ++count; });
      flow.direction.row(r) = sum.transpose() / count;
    }
  }
  double mean = 0;
  std::ptrdiff_t count = 0;
  for (std::size_t r = 0; r < solved.size(); ++r)
    if (solved[r]) mean += flow.direction.row(static_cast<Eigen::Index>(r)).norm(), ++count;
  const double least = count > 0 ? 1e-2 * mean / static_cast<double>(count) : 0;
  for (Eigen::Index r = 0; r < flow.direction.rows(); ++r) {
    const double size = flow.direction.row(r).norm();
    if (solved[static_cast<std::size_t>(r)] && size > least)
      flow.direction.row(r) /= size;
    else
      flow.direction.row(r).setZero();
  }
  spread_directions(grid, flow, solved);
}

/// Flags of the rows in pieces for which `good` holds; `pieces` per row.
template <class Good>
Rows rows_in(const std::vector<int>& pieces, const Good& good) {
  Rows rows(pieces.size());
  for (std::size_t r = 0; r < rows.size(); ++r) rows[r] = good(static_cast<std::size_t>(pieces[r])) ? 1 : 0;
  return rows;
}

std::vector<int> pieces_of_rows(const VoxelGrid& grid, const VoxelFlags& domain, const HarmonicFlow& flow) {
  const std::vector<int> labels = voxel_pieces(grid, domain);
  std::vector<int> pieces(flow.voxels.size());
  for (std::size_t r = 0; r < pieces.size(); ++r) pieces[r] = labels[static_cast<std::size_t>(flow.voxels[r])];
  return pieces;
}

/// The angle of a voxel round the axis, in turns, from -1/2 to 1/2.
class Angle {
 public:
  Angle(const Vector3d& centre, const Vector3d& axis)
      : centre_(centre), axis_(axis.normalized()), first_(axis_.unitOrthogonal()), second_(axis_.cross(first_)) {}
  double operator()(const Vector3d& p) const {
    return std::atan2((p - centre_).dot(second_), (p - centre_).dot(first_)) / (2 * std::numbers::pi);
  }
  double radius(const Vector3d& p) const { return axis_.cross(p - centre_).norm(); }
  Vector3d tangent(const Vector3d& p) const { return axis_.cross(p - centre_); }

 private:
  Vector3d centre_, axis_, first_, second_;
};

}  // namespace

std::ptrdiff_t HarmonicFlow::solved_count() const {
  std::ptrdiff_t count = 0;
  for (Eigen::Index r = 0; r < direction.rows(); ++r) count += solved(static_cast<int>(r)) ? 1 : 0;
  return count;
}

HarmonicFlow flow_between(const VoxelGrid& grid, const VoxelFlags& domain, const MatrixX3d& origin,
                          const MatrixX3d& insertion) {
  HarmonicFlow flow = start(grid, domain);
  const std::vector<int> pieces = pieces_of_rows(grid, domain, flow);
  const double limit = longest_end * mean_distance(origin, insertion);
  const Rows first = rows_of_end(grid, flow, origin, limit);
  Rows last = rows_of_end(grid, flow, insertion, limit);
  std::vector<int> ends(pieces.size() + 1, 0);  // per piece: 1 has an origin, 2 an insertion, 3 both
  for (std::size_t r = 0; r < pieces.size(); ++r) {
    if (first[r]) last[r] = 0;
    ends[static_cast<std::size_t>(pieces[r])] |= (first[r] ? 1 : 0) | (last[r] ? 2 : 0);
  }
  const Rows solved = rows_in(pieces, [&ends](std::size_t piece) { return ends[piece] == 3; });
  std::vector<int> unknown(pieces.size(), -1);
  int n = 0;
  for (std::size_t r = 0; r < pieces.size(); ++r) {
    if (last[r]) flow.value[static_cast<Eigen::Index>(r)] = 1;
    if (solved[r] && !first[r] && !last[r]) unknown[r] = n++;
  }
  if (n > 0) {
    std::vector<Eigen::Triplet<double>> entries;
    VectorXd right = VectorXd::Zero(n);
    for (std::size_t r = 0; r < pieces.size(); ++r) {
      const int i = unknown[r];
      if (i < 0) continue;
      int count = 0;
      each_neighbour(grid, flow, static_cast<Eigen::Index>(r), [&](int, int, int other) {
        ++count;
        const int k = unknown[static_cast<std::size_t>(other)];
        if (k >= 0)
          entries.emplace_back(i, k, -1);
        else
          right[i] += flow.value[other];
      });
      entries.emplace_back(i, i, count);
    }
    SparseMatrixd L(n, n);
    L.setFromTriplets(entries.begin(), entries.end());
    const VectorXd u = SparseCholesky(L).solve(right);
    for (std::size_t r = 0; r < pieces.size(); ++r)
      if (unknown[r] >= 0) flow.value[static_cast<Eigen::Index>(r)] = u[unknown[r]];
  }
  for (Eigen::Index r = 0; r < flow.value.size(); ++r) {
    if (!solved[static_cast<std::size_t>(r)]) continue;
    each_neighbour(grid, flow, r, [&](int axis, int way, int other) {
      flow.direction(r, axis) += 0.5 * way * (flow.value[other] - flow.value[r]) / grid.spacing;
    });
  }
  normalise(grid, flow, solved);
  return flow;
}

HarmonicFlow flow_round(const VoxelGrid& grid, const VoxelFlags& domain, const Vector3d& centre, const Vector3d& axis) {
  HarmonicFlow flow = start(grid, domain);
  const std::vector<int> pieces = pieces_of_rows(grid, domain, flow);
  const Angle angle(centre, axis);
  const auto n = static_cast<Eigen::Index>(flow.voxels.size());
  if (n == 0) return flow;
  VectorXd turn(n);
  for (Eigen::Index r = 0; r < n; ++r) turn[r] = angle(grid.centre(flow.voxels[static_cast<std::size_t>(r)]));
  // The jump of the angle on the way from row r to its neighbour: one turn where the cut is crossed.
  const auto jump = [&turn](Eigen::Index r, Eigen::Index other) { return -std::round(turn[other] - turn[r]); };
  std::vector<Eigen::Triplet<double>> entries;
  VectorXd right = VectorXd::Zero(n);
  std::vector<char> anchored(pieces.size(), 0);
  for (Eigen::Index r = 0; r < n; ++r) {
    const auto piece = static_cast<std::size_t>(pieces[static_cast<std::size_t>(r)]);
    double diagonal = anchored[piece] ? 0 : 1;  // one row of each piece is held, at zero
    anchored[piece] = 1;
    each_neighbour(grid, flow, r, [&](int, int, int other) {
      entries.emplace_back(r, other, -1);
      right[r] += jump(r, other);
      ++diagonal;
    });
    entries.emplace_back(r, r, diagonal);
  }
  SparseMatrixd L(n, n);
  L.setFromTriplets(entries.begin(), entries.end());
  flow.value = SparseCholesky(L).solve(right);
  // In a ring about the axis the flow is about 1 / circumference; in a piece that does not close it vanishes.
  VectorXd turning = VectorXd::Zero(static_cast<Eigen::Index>(pieces.size())), size = turning;
  for (Eigen::Index r = 0; r < n; ++r) {
    each_neighbour(grid, flow, r, [&](int k, int way, int other) {
      flow.direction(r, k) += 0.5 * way * (flow.value[other] - flow.value[r] + jump(r, other)) / grid.spacing;
    });
    const int piece = pieces[static_cast<std::size_t>(r)];
    const double circumference =
        2 * std::numbers::pi * angle.radius(grid.centre(flow.voxels[static_cast<std::size_t>(r)]));
    turning[piece] += flow.direction.row(r).norm() * circumference;
    size[piece] += 1;
  }
  normalise(grid, flow, rows_in(pieces, [&](std::size_t piece) {
              const auto i = static_cast<Eigen::Index>(piece);
              return turning[i] > smallest_turning * size[i];
            }));
  return flow;
}

HarmonicFlow circles_round(const VoxelGrid& grid, const VoxelFlags& domain, const Vector3d& centre,
                           const Vector3d& axis) {
  HarmonicFlow flow = start(grid, domain);
  const Angle angle(centre, axis);
  for (std::size_t r = 0; r < flow.voxels.size(); ++r) {
    const Vector3d p = grid.centre(flow.voxels[r]);
    const auto i = static_cast<Eigen::Index>(r);
    flow.value[i] = angle(p);
    flow.direction.row(i) = angle.tangent(p).stableNormalized().transpose();
  }
  return flow;
}

}  // namespace phiz
