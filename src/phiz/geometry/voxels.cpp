// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/geometry/voxels.h"

#include <spdlog/fmt/fmt.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

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

/// The triangles of each voxel: those whose plane meets its cube within the triangle's box, which is all that meet it
/// and few others.
struct CutVoxels {
  std::vector<int> begin;      // per voxel and one more: first entry in `triangles`
  std::vector<int> triangles;  // rows of F

  bool cut(std::ptrdiff_t voxel) const { return begin[at(voxel)] < begin[at(voxel) + 1]; }
};

/// Calls visit(voxel, triangle) for every voxel that a triangle may meet.
template <class Visit>
void each_cut(const VoxelGrid& grid, const TriangleMesh& surface, const Visit& visit) {
  for (int f = 0; f < surface.F.rows(); ++f) {
    const Vector3d a = surface.V.row(surface.F(f, 0)), b = surface.V.row(surface.F(f, 1)),
                   c = surface.V.row(surface.F(f, 2));
    const Vector3d bottom = a.cwiseMin(b).cwiseMin(c), top = a.cwiseMax(b).cwiseMax(c);
    const Eigen::Vector3i low = ((bottom - grid.low).array() / grid.spacing - 1e-6).floor().cast<int>();
    const Eigen::Vector3i high = ((top - grid.low).array() / grid.spacing + 1e-6).floor().cast<int>();
    const Vector3d normal = (b - a).cross(c - a);
    const double reach = (0.5 + 1e-6) * grid.spacing * normal.lpNorm<1>();
    for (int z = low.z(); z <= high.z(); ++z)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int x = low.x(); x <= high.x(); ++x) {
          const std::ptrdiff_t voxel = x + y * grid.stride(1) + z * grid.stride(2);
          if (std::abs(normal.dot(grid.centre(voxel) - a)) <= reach) visit(voxel, f);
        }
  }
}

CutVoxels cut_voxels(const VoxelGrid& grid, const TriangleMesh& surface) {
  CutVoxels cut;
  cut.begin.assign(at(grid.count()) + 1, 0);
  each_cut(grid, surface, [&cut](std::ptrdiff_t voxel, int) { ++cut.begin[at(voxel) + 1]; });
  for (std::size_t i = 1; i < cut.begin.size(); ++i) cut.begin[i] += cut.begin[i - 1];
  cut.triangles.resize(static_cast<std::size_t>(cut.begin.back()));
  std::vector<int> next(cut.begin.begin(), cut.begin.end() - 1);
  each_cut(grid, surface,
           [&](std::ptrdiff_t voxel, int f) { cut.triangles[static_cast<std::size_t>(next[at(voxel)]++)] = f; });
  return cut;
}

/// How the winding number changes from p to q through a triangle: 1 when q is behind it, -1 when p is, 0 when the way
/// misses it; nothing when it passes so close to an edge that this is not sure.
std::optional<int> crossing(const Vector3d& p, const Vector3d& q, const Vector3d& a, const Vector3d& b,
                            const Vector3d& c) {
  const Vector3d normal = (b - a).cross(c - a);
  const double from = normal.dot(p - a), to = normal.dot(q - a);
  const double scale = normal.norm() * ((b - a).norm() + (c - a).norm()), unsure = 1e-9 * scale;
  if (std::abs(from) < unsure || std::abs(to) < unsure) return std::nullopt;
  if ((from > 0) == (to > 0)) return 0;
  const Vector3d x = p + from / (from - to) * (q - p);
  double least = 1e300;
  for (const auto& [u, v] : {std::pair{&a, &b}, std::pair{&b, &c}, std::pair{&c, &a}})
    least = std::min(least, (*v - *u).cross(x - *u).dot(normal) / normal.squaredNorm());
  if (std::abs(least) < 1e-9) return std::nullopt;
  return least < 0 ? 0 : from > 0 ? 1 : -1;
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
  TriangleMesh surface;
  SurfaceQuery query;
  VoxelGrid grid;
  CutVoxels cut;
  VoxelFlags inside;
  std::vector<std::int8_t> winding;  // of the centres of cut voxels, rounded, at most 100

  explicit State(const TriangleMesh& mesh) : surface(mesh), query(mesh) {}
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
  s.inside.assign(at(s.grid.count()), 0);
  s.winding.assign(s.inside.size(), 0);
  // Between voxels that no triangle meets nothing changes from outside to inside: one question per piece of them.
  std::vector<int> labels(s.inside.size(), -1);
  std::vector<char> piece_inside;
  const auto whole = [&s](std::ptrdiff_t voxel) { return !s.cut.cut(voxel); };
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
    const double winding = std::clamp(s.query.winding_number(s.grid.centre(voxel)), -100.0, 100.0);
    s.winding[at(voxel)] = static_cast<std::int8_t>(std::lround(winding));
    s.inside[at(voxel)] = winding > 0.5 ? 1 : 0;
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
  const State& s = *state_;
  const std::ptrdiff_t voxel = s.grid.holding(p);
  if (voxel < 0) return false;
  if (!s.cut.cut(voxel)) return s.inside[at(voxel)] != 0;
  // The way from the centre to p stays in the voxel, so it crosses none but the voxel's triangles.
  int winding = s.winding[at(voxel)];
  const Vector3d centre = s.grid.centre(voxel);
  for (int i = s.cut.begin[at(voxel)]; i < s.cut.begin[at(voxel) + 1]; ++i) {
    const auto f = s.surface.F.row(s.cut.triangles[static_cast<std::size_t>(i)]);
    const std::optional<int> change =
        crossing(centre, p, s.surface.V.row(f(0)), s.surface.V.row(f(1)), s.surface.V.row(f(2)));
    if (!change) return s.query.is_inside(p);
    winding += *change;
  }
  return winding > 0;
}

}  // namespace phiz
