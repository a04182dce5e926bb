// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/fibre_field.h"

#include <algorithm>
#include <cmath>

#include "phiz/anatomy/fibre_state.h"
#include "phiz/core/error.h"
#include "phiz/geometry/remesh.h"
#include "phiz/geometry/surface.h"

namespace phiz {

namespace {

constexpr double enough = 0.9;  // share of the voxels that must have a direction of their own

void check(const MuscleShape& shape) {
  const std::string where = "muscle " + shape.name;
  if (shape.surface.F.rows() == 0) reject(where, "it has no surface");
  if (shape.ring) {
    if (!shape.ring_centre.allFinite() || !(shape.ring_axis.norm() > 1e-9))
      reject(where, "the centre or the axis of the ring is missing or not finite");
    return;
  }
  for (const auto& [points, end] : {std::pair{&shape.origin, "origin"}, std::pair{&shape.insertion, "insertion"}}) {
    if (points->rows() == 0) reject(where, std::string("it has no ") + end);
    if (!points->allFinite()) reject(where, std::string("its ") + end + " is not finite");
  }
}

SurfaceVoxels voxels_of(const MuscleShape& shape, const FibreOptions& options) {
  const double volume = std::abs(signed_volume(shape.surface.V, shape.surface.F));
  double spacing = std::max(options.spacing, std::cbrt(volume / options.most_voxels));
  for (int attempt = 0; attempt < 3; ++attempt, spacing /= 2) {
    SurfaceVoxels voxels(shape.surface, spacing, options.widest_gap);
    const VoxelFlags& inside = voxels.inside();
    if (std::find(inside.begin(), inside.end(), 1) != inside.end()) return voxels;
  }
  reject("muscle " + shape.name, "its surface encloses nothing", "it must be closed and face outward");
}

HarmonicFlow solve(const MuscleShape& shape, const VoxelGrid& grid, const VoxelFlags& domain) {
  return shape.ring ? flow_round(grid, domain, shape.ring_centre, shape.ring_axis)
                    : flow_between(grid, domain, shape.origin, shape.insertion);
}

/// How many of the voxels inside have a direction.
std::ptrdiff_t covered(const HarmonicFlow& flow, const VoxelFlags& inside) {
  std::ptrdiff_t count = 0;
  for (std::size_t r = 0; r < flow.voxels.size(); ++r)
    count += inside[static_cast<std::size_t>(flow.voxels[r])] && flow.solved(static_cast<int>(r)) ? 1 : 0;
  return count;
}

/// The flow on the voxels inside, closing gaps as far as needed.
HarmonicFlow flow_of(const MuscleShape& shape, const SurfaceVoxels& voxels, double widest_gap) {
  const VoxelFlags& inside = voxels.inside();
  const auto all = static_cast<double>(std::count(inside.begin(), inside.end(), 1));
  HarmonicFlow best;
  std::ptrdiff_t most = 0;
  for (const double share : {0.0, 0.25, 0.5, 1.0}) {
    const VoxelFlags domain = share > 0 ? close_gaps(voxels.grid(), inside, share * widest_gap) : inside;
    HarmonicFlow flow = solve(shape, voxels.grid(), domain);
    const std::ptrdiff_t count = covered(flow, inside);
    if (count > most) most = count, best = std::move(flow);
    if (static_cast<double>(most) >= enough * all) break;
  }
  if (most > 0) return best;
  if (shape.ring) return circles_round(voxels.grid(), inside, shape.ring_centre, shape.ring_axis);
  reject("muscle " + shape.name, "no part of it leads from its origin to its insertion",
         "the points of both must lie on its surface, apart from each other");
}

}  // namespace

FibreField::FibreField(const MuscleShape& shape, const FibreOptions& options) {
  check(shape);
  SurfaceVoxels voxels = voxels_of(shape, options);
  HarmonicFlow flow = flow_of(shape, voxels, options.widest_gap);
  state_ = std::make_unique<State>(
      State{std::move(voxels),
            std::move(flow),
            shape.ring,
            shape.ring_centre,
            shape.ring_axis,
            {shape.surface.V.colwise().minCoeff().transpose(), shape.surface.V.colwise().maxCoeff().transpose()}});
}

FibreField::~FibreField() = default;
FibreField::FibreField(FibreField&&) noexcept = default;
FibreField& FibreField::operator=(FibreField&&) noexcept = default;

Eigen::AlignedBox3d FibreField::box() const {
  return state_->box;
}

bool FibreField::contains(const Vector3d& p) const {
  return state_->voxels.contains(p);
}

Vector3d FibreField::direction(const Vector3d& p) const {
  const State& s = *state_;
  const VoxelGrid& grid = s.grid();
  const Vector3d place = ((p - grid.low) / grid.spacing).array() - 0.5;
  const Eigen::Vector3i corner = place.array().floor().cast<int>();
  Vector3d sum = Vector3d::Zero();
  // Voxels corner - reach to corner + 1 + reach: the eight round p first, then farther ones until some are found.
  const auto collect = [&](int reach) {
    const Eigen::Vector3i low = (corner.array() - reach).max(0);
    const Eigen::Vector3i high = (corner.array() + 1 + reach).min(grid.size.array() - 1);
    for (int z = low.z(); z <= high.z(); ++z)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int x = low.x(); x <= high.x(); ++x) {
          const int r = s.flow.row[static_cast<std::size_t>(x + y * grid.stride(1) + z * grid.stride(2))];
          if (r < 0 || !s.flow.solved(r)) continue;
          const Vector3d apart = (place - Vector3d(x, y, z)).cwiseAbs();
          const double weight = reach == 0 ? (1 - apart.array()).max(1e-3).prod() : 1 / apart.squaredNorm();
          sum += weight * s.flow.direction.row(r).transpose();
        }
  };
  const int farthest = grid.size.maxCoeff() + (corner.cwiseAbs().maxCoeff());
  for (int reach = 0; reach <= farthest && sum.norm() < 1e-9; reach = 2 * reach + 1) collect(reach);
  return sum.norm() < 1e-9 ? Vector3d(s.flow.direction.row(0).transpose()) : sum.normalized();
}

TriangleMesh FibreField::voxel_surface() const {
  const State& s = *state_;
  const VoxelGrid& grid = s.grid();
  const auto filled = [&](const Eigen::Vector3i& cell) {
    if (cell.minCoeff() < 0 || (cell.array() >= grid.size.array()).any()) return 0.0;
    const auto voxel = static_cast<std::size_t>(cell.x() + cell.y() * grid.stride(1) + cell.z() * grid.stride(2));
    return s.flow.row[voxel] >= 0 ? 1.0 : 0.0;
  };
  const auto outside = [&](const Vector3d& p) {
    const Vector3d place = ((p - grid.low) / grid.spacing).array() - 0.5;
    const Eigen::Vector3i corner = place.array().floor().cast<int>();
    double sum = 0;
    for (int z = 0; z < 2; ++z)
      for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 2; ++x) {
          const Eigen::Vector3i cell = corner + Eigen::Vector3i(x, y, z);
          sum += filled(cell) * (1 - (place - cell.cast<double>()).cwiseAbs().array()).max(0).prod();
        }
    return 0.5 - sum;
  };
  PolygoniseOptions options;
  options.edge_length = 1.5 * grid.spacing;
  const Vector3d high = grid.low + grid.spacing * grid.size.cast<double>();
  const double rim = 4 * options.edge_length;
  return polygonise(outside, {grid.low.array() - rim, high.array() + rim}, options);
}

}  // namespace phiz
