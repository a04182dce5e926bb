// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/geometry/voxels.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/geometry/spatial_query.h"
#include "phiz/geometry/validate.h"

namespace phiz {

namespace {

constexpr double most_voxels = 2e8;

std::size_t at(std::ptrdiff_t voxel) {
  return static_cast<std::size_t>(voxel);
}

/// Collects the piece of voxels with `member` that holds `seed`, marking it with `label`.
template <class Member>
void flood(const VoxelGrid& grid, std::ptrdiff_t seed, int label, std::vector<int>& labels, const Member& member) {
  std::vector<std::ptrdiff_t> open{seed};
  labels[at(seed)] = label;
  while (!open.empty()) {
    const std::ptrdiff_t voxel = open.back();
    open.pop_back();
    const Eigen::Vector3i cell = grid.cell(voxel);
    for (int axis = 0; axis < 3; ++axis)
      for (const int way : {-1, 1}) {
        if (cell[axis] + way < 0 || cell[axis] + way >= grid.size[axis]) continue;
        const std::ptrdiff_t next = voxel + way * grid.stride(axis);
        if (labels[at(next)] >= 0 || !member(next)) continue;
        labels[at(next)] = label;
        open.push_back(next);
      }
  }
}

/// Voxels whose cube the box of a triangle meets.
VoxelFlags cut_voxels(const VoxelGrid& grid, const TriangleMesh& surface) {
  VoxelFlags cut(at(grid.count()), 0);
  for (Eigen::Index f = 0; f < surface.F.rows(); ++f) {
    const Eigen::Matrix<double, 3, 3> corners = surface.V(surface.F.row(f), Eigen::all);
    Eigen::Vector3i low, high;
    for (int k = 0; k < 3; ++k) {
      low[k] = static_cast<int>(std::floor((corners.col(k).minCoeff() - grid.low[k]) / grid.spacing - 1e-6));
      high[k] = static_cast<int>(std::floor((corners.col(k).maxCoeff() - grid.low[k]) / grid.spacing + 1e-6));
    }
    for (int z = low.z(); z <= high.z(); ++z)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int x = low.x(); x <= high.x(); ++x) cut[at(x + y * grid.stride(1) + z * grid.stride(2))] = 1;
  }
  return cut;
}

}  // namespace

Eigen::Vector3i VoxelGrid::cell(std::ptrdiff_t voxel) const {
  const std::ptrdiff_t nx = size.x(), ny = size.y();
  return {static_cast<int>(voxel % nx), static_cast<int>(voxel / nx % ny), static_cast<int>(voxel / (nx * ny))};
}

std::ptrdiff_t VoxelGrid::holding(const Vector3d& p) const {
  std::ptrdiff_t voxel = 0;
  for (int k = 0; k < 3; ++k) {
    const double c = std::floor((p[k] - low[k]) / spacing);
    if (!(c >= 0 && c < size[k])) return -1;
    voxel += static_cast<std::ptrdiff_t>(c) * stride(k);
  }
  return voxel;
}

VoxelFlags dilate(const VoxelGrid& grid, const VoxelFlags& flags, double radius) {
  const int reach = static_cast<int>(radius / grid.spacing);
  const double limit = radius * radius / (grid.spacing * grid.spacing) + 1e-9;
  std::vector<Eigen::Vector3i> ball;
  for (int z = -reach; z <= reach; ++z)
    for (int y = -reach; y <= reach; ++y)
      for (int x = -reach; x <= reach; ++x)
        if (x * x + y * y + z * z <= limit) ball.emplace_back(x, y, z);
  VoxelFlags result = flags;
  for (std::ptrdiff_t voxel = 0; voxel < grid.count(); ++voxel) {
    if (!flags[at(voxel)]) continue;
    const Eigen::Vector3i cell = grid.cell(voxel);
    bool rim = false;  // only voxels at the rim reach others
    for (int axis = 0; axis < 3; ++axis)
      for (const int way : {-1, 1})
        if (cell[axis] + way >= 0 && cell[axis] + way < grid.size[axis])
          rim = rim || !flags[at(voxel + way * grid.stride(axis))];
    if (!rim) continue;
    for (const Eigen::Vector3i& offset : ball) {
      const Eigen::Vector3i to = cell + offset;
      if (to.minCoeff() < 0 || (to.array() >= grid.size.array()).any()) continue;
      result[at(to.x() + to.y() * grid.stride(1) + to.z() * grid.stride(2))] = 1;
    }
  }
  return result;
}

VoxelFlags close_gaps(const VoxelGrid& grid, const VoxelFlags& flags, double radius) {
  VoxelFlags outside = dilate(grid, flags, radius);
  for (char& flag : outside) flag = flag ? 0 : 1;
  VoxelFlags closed = dilate(grid, outside, radius);
  for (std::size_t i = 0; i < closed.size(); ++i) closed[i] = flags[i] || !closed[i] ? 1 : 0;
  return closed;
}

std::vector<int> voxel_pieces(const VoxelGrid& grid, const VoxelFlags& flags) {
  std::vector<int> labels(flags.size(), -1);
  int count = 0;
  for (std::ptrdiff_t voxel = 0; voxel < grid.count(); ++voxel)
    if (flags[at(voxel)] && labels[at(voxel)] < 0)
      flood(grid, voxel, count++, labels, [&flags](std::ptrdiff_t next) { return flags[at(next)] != 0; });
  return labels;
}

struct SurfaceVoxels::State {
  SurfaceQuery query;
  VoxelGrid grid;
  VoxelFlags cut, inside;

  explicit State(const TriangleMesh& surface) : query(surface) {}
};

SurfaceVoxels::SurfaceVoxels(const TriangleMesh& surface, double spacing, double margin) {
  validate(surface, "voxels");
  state_ = std::make_unique<State>(surface);
  State& s = *state_;
  s.grid.spacing = spacing;
  const double rim = std::max(margin, spacing) + spacing;
  s.grid.low = (surface.V.colwise().minCoeff().array() - rim).matrix().transpose();
  const Vector3d cells = (surface.V.colwise().maxCoeff().transpose() - s.grid.low).array() / spacing + rim / spacing;
  if (!(cells.array().ceil().prod() <= most_voxels))
    reject("voxels", fmt::format("the grid would have {:.3g} voxels", cells.array().ceil().prod()),
           "use a longer edge");
  s.grid.size = cells.array().ceil().cast<int>();
  s.cut = cut_voxels(s.grid, surface);
  s.inside.assign(s.cut.size(), 0);
  // Between voxels that no triangle meets nothing changes from outside to inside: one question per piece of them.
  std::vector<int> labels(s.cut.size(), -1);
  std::vector<char> piece_inside;
  const auto whole = [&s](std::ptrdiff_t voxel) { return !s.cut[at(voxel)]; };
  std::vector<std::ptrdiff_t> near;
  for (std::ptrdiff_t voxel = 0; voxel < s.grid.count(); ++voxel) {
    if (!whole(voxel)) {
      near.push_back(voxel);
      continue;
    }
    if (labels[at(voxel)] < 0) {
      flood(s.grid, voxel, static_cast<int>(piece_inside.size()), labels, whole);
      piece_inside.push_back(s.query.is_inside(s.grid.centre(voxel)) ? 1 : 0);
    }
    s.inside[at(voxel)] = piece_inside[static_cast<std::size_t>(labels[at(voxel)])];
  }
  parallel_for(static_cast<std::ptrdiff_t>(near.size()), [&](std::ptrdiff_t i) {
    const std::ptrdiff_t voxel = near[at(i)];
    s.inside[at(voxel)] = s.query.is_inside(s.grid.centre(voxel)) ? 1 : 0;
  });
}

SurfaceVoxels::~SurfaceVoxels() = default;
SurfaceVoxels::SurfaceVoxels(SurfaceVoxels&&) noexcept = default;
SurfaceVoxels& SurfaceVoxels::operator=(SurfaceVoxels&&) noexcept = default;

const VoxelGrid& SurfaceVoxels::grid() const {
  return state_->grid;
}

const VoxelFlags& SurfaceVoxels::inside() const {
  return state_->inside;
}

bool SurfaceVoxels::contains(const Vector3d& p) const {
  const std::ptrdiff_t voxel = state_->grid.holding(p);
  if (voxel < 0) return false;
  return state_->cut[at(voxel)] ? state_->query.is_inside(p) : state_->inside[at(voxel)] != 0;
}

}  // namespace phiz
