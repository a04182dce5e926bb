// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/geometry/solidify.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "phiz/core/error.h"
#include "phiz/core/parallel.h"

namespace phiz {

namespace {

Vector3d first_centre(const VoxelGrid& grid) {
  return grid.low.array() + 0.5 * grid.spacing;
}

std::size_t row(const VoxelGrid& grid, int i, int j, int k) {
  return static_cast<std::size_t>(i + j * grid.stride(1) + k * grid.stride(2));
}

constexpr float unreached = 1e6F;  // in cells, more than any grid is wide

/// Squared distance transform of one line: d[i] = min over j of (i - j)^2 + f[j].
void transform_line(std::vector<float>& f, std::vector<float>& d, std::vector<int>& hull, std::vector<float>& from) {
  const int n = static_cast<int>(f.size());
  int k = 0;
  hull[0] = 0;
  from[0] = -std::numeric_limits<float>::infinity();
  from[1] = std::numeric_limits<float>::infinity();
  const auto meet = [&](int p, int q) {  // where parabola q overtakes p
    return (f[q] + static_cast<float>(q) * q - f[p] - static_cast<float>(p) * p) / (2.0F * static_cast<float>(q - p));
  };
  for (int q = 1; q < n; ++q) {
    float s = meet(hull[k], q);
    while (k > 0 && s <= from[k]) s = meet(hull[--k], q);
    hull[++k] = q;
    from[k] = s;
    from[k + 1] = std::numeric_limits<float>::infinity();
  }
  k = 0;
  for (int q = 0; q < n; ++q) {
    while (from[k + 1] < static_cast<float>(q)) ++k;
    const auto step = static_cast<float>(q - hull[k]);
    d[q] = step * step + f[hull[k]];
  }
}

/// Applies transform_line along one axis.
void transform_axis(const VoxelGrid& grid, int axis, std::vector<float>& values) {
  const int n = grid.size[axis], u = (axis + 1) % 3, v = (axis + 2) % 3;
  const std::array<std::size_t, 3> stride{1, static_cast<std::size_t>(grid.stride(1)),
                                          static_cast<std::size_t>(grid.stride(2))};
  parallel_chunks(static_cast<std::ptrdiff_t>(grid.size[u]) * grid.size[v], 512,
                  [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                    std::vector<float> f(n), d(n), from(n + 2);
                    std::vector<int> hull(n + 1);
                    for (std::ptrdiff_t line = begin; line < end; ++line) {
                      const std::size_t start = stride[u] * (line % grid.size[u]) + stride[v] * (line / grid.size[u]);
                      for (int i = 0; i < n; ++i) f[i] = values[start + stride[axis] * i];
                      transform_line(f, d, hull, from);
                      for (int i = 0; i < n; ++i) values[start + stride[axis] * i] = d[i];
                    }
                  });
}

VoxelFlags inverted(const VoxelFlags& marks) {
  VoxelFlags result(marks.size());
  for (std::size_t c = 0; c < marks.size(); ++c) result[c] = marks[c] == 0 ? 1 : 0;
  return result;
}

/// The free cells that are connected with the sides of the grid.
VoxelFlags outside_of(const VoxelGrid& grid, const VoxelFlags& solid) {
  VoxelFlags outside(solid.size(), 0);
  std::vector<Eigen::Vector3i> open;
  const auto visit = [&](int i, int j, int k) {
    const std::size_t c = row(grid, i, j, k);
    if (solid[c] || outside[c]) return;
    outside[c] = 1;
    open.emplace_back(i, j, k);
  };
  const Eigen::Vector3i n = grid.size;
  for (int k = 0; k < n.z(); ++k)
    for (int j = 0; j < n.y(); ++j)
      for (int i = 0; i < n.x(); ++i)
        if (i == 0 || j == 0 || k == 0 || i == n.x() - 1 || j == n.y() - 1 || k == n.z() - 1) visit(i, j, k);
  while (!open.empty()) {
    const Eigen::Vector3i at = open.back();
    open.pop_back();
    for (int axis = 0; axis < 3; ++axis) {
      for (const int step : {-1, 1}) {
        Eigen::Vector3i to = at;
        to[axis] += step;
        if (to[axis] >= 0 && to[axis] < n[axis]) visit(to.x(), to.y(), to.z());
      }
    }
  }
  return outside;
}

}  // namespace

std::vector<Vector3d> sphere_directions(int count) {
  std::vector<Vector3d> result;
  for (int i = 0; i < count; ++i) {
    const double y = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - y * y);
    const double turn = std::numbers::pi * (3 - std::sqrt(5.0)) * i;
    result.emplace_back(r * std::cos(turn), y, r * std::sin(turn));
  }
  return result;
}

VoxelGrid grid_round(const Box& box, double spacing, double margin) {
  VoxelGrid grid;
  grid.spacing = spacing;
  grid.low = box.low - Vector3d::Constant(margin + 0.5 * spacing);
  const Vector3d cells = (box.high - box.low + Vector3d::Constant(2 * margin)) / spacing;
  if (!(cells.prod() < 3e8)) reject("grid", fmt::format("would have {:.3g} cells", cells.prod()), "use larger cells");
  grid.size = (cells.array().ceil() + 1).cast<int>();
  return grid;
}

void fill_inside(const VoxelGrid& grid, const TriangleMesh& mesh, VoxelFlags& solid) {
  // Crossings of the line along x through the centres of each row of cells: position and whether it enters.
  struct Crossing {
    double x;
    int turn;
  };
  const auto rows = static_cast<std::size_t>(grid.size.y()) * grid.size.z();
  std::vector<std::vector<Crossing>> crossings(rows);
  // A tiny shift keeps the lines off vertices that lie on the lattice.
  const double shift_y = 1.234567e-4 * grid.spacing, shift_z = 2.345678e-4 * grid.spacing;
  for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
    Matrix3d p;
    for (int c = 0; c < 3; ++c) p.col(c) = (mesh.V.row(mesh.F(f, c)).transpose() - first_centre(grid)) / grid.spacing;
    const double area = (p(1, 1) - p(1, 0)) * (p(2, 2) - p(2, 0)) - (p(1, 2) - p(1, 0)) * (p(2, 1) - p(2, 0));
    if (area == 0) continue;
    const int j0 = std::max(0, static_cast<int>(std::floor(p.row(1).minCoeff())));
    const int j1 = std::min(grid.size.y() - 1, static_cast<int>(std::ceil(p.row(1).maxCoeff())));
    const int k0 = std::max(0, static_cast<int>(std::floor(p.row(2).minCoeff())));
    const int k1 = std::min(grid.size.z() - 1, static_cast<int>(std::ceil(p.row(2).maxCoeff())));
    for (int k = k0; k <= k1; ++k) {
      for (int j = j0; j <= j1; ++j) {
        const double y = j + shift_y / grid.spacing, z = k + shift_z / grid.spacing;
        Vector3d w;
        for (int c = 0; c < 3; ++c) {
          const int a = (c + 1) % 3, b = (c + 2) % 3;
          w[c] = ((p(1, a) - y) * (p(2, b) - z) - (p(1, b) - y) * (p(2, a) - z)) / area;
        }
        if (w.minCoeff() < 0) continue;
        crossings[static_cast<std::size_t>(j) + static_cast<std::size_t>(grid.size.y()) * k].push_back(
            {p.row(0) * w, area < 0 ? 1 : -1});
      }
    }
  }
  parallel_for(
      static_cast<std::ptrdiff_t>(rows),
      [&](std::ptrdiff_t r) {
        auto& line = crossings[static_cast<std::size_t>(r)];
        std::sort(line.begin(), line.end(), [](const Crossing& a, const Crossing& b) { return a.x < b.x; });
        int inside = 0;
        for (std::size_t c = 0; c + 1 < line.size(); ++c) {
          inside += line[c].turn;
          if (inside <= 0) continue;
          const int first = std::max(0, static_cast<int>(std::ceil(line[c].x)));
          const int last = std::min(grid.size.x() - 1, static_cast<int>(std::floor(line[c + 1].x)));
          for (int i = first; i <= last; ++i) solid[static_cast<std::size_t>(r) * grid.size.x() + i] = 1;
        }
      },
      256);
}

std::vector<float> distance_to(const VoxelGrid& grid, const VoxelFlags& marked) {
  std::vector<float> values(static_cast<std::size_t>(grid.count()));
  for (std::size_t c = 0; c < values.size(); ++c) values[c] = marked[c] ? 0.0F : unreached * unreached;
  for (int axis = 0; axis < 3; ++axis) transform_axis(grid, axis, values);
  const auto cell = static_cast<float>(grid.spacing);
  for (float& value : values) value = cell * std::min(unreached, std::sqrt(value));
  return values;
}

void seal_gaps(const VoxelGrid& grid, double radius, VoxelFlags& solid) {
  const std::vector<float> from_solid = distance_to(grid, solid);
  VoxelFlags grown(solid.size());
  for (std::size_t c = 0; c < grown.size(); ++c) grown[c] = from_solid[c] < radius ? 1 : 0;
  const std::vector<float> from_outside = distance_to(grid, outside_of(grid, grown));
  for (std::size_t c = 0; c < solid.size(); ++c)
    if (from_outside[c] > radius) solid[c] = 1;
}

void fill_caves(const VoxelGrid& grid, double hidden, int coarse, VoxelFlags& solid) {
  constexpr int rays = 96;
  const std::vector<Vector3d> towards = sphere_directions(rays);
  const Eigen::Vector3i blocks = (grid.size.array() + coarse - 1) / coarse;
  VoxelFlags cave(static_cast<std::size_t>(blocks.prod()), 0);
  const std::vector<float> distance = distance_to(grid, solid);
  const auto nearest = [&](const Vector3d& q) {  // in cells
    return distance[row(grid, static_cast<int>(std::lround(q.x())), static_cast<int>(std::lround(q.y())),
                        static_cast<int>(std::lround(q.z())))] /
           grid.spacing;
  };
  const auto inside = [&](const Vector3d& q) {
    return (q.array() >= 0).all() && (q.array() <= (grid.size.array() - 1).cast<double>()).all();
  };
  parallel_for(
      static_cast<std::ptrdiff_t>(cave.size()),
      [&](std::ptrdiff_t b) {
        const auto bi = static_cast<int>(b % blocks.x()), bj = static_cast<int>(b / blocks.x() % blocks.y()),
                   bk = static_cast<int>(b / blocks.x() / blocks.y());
        const Vector3d at = (Vector3d(bi, bj, bk) * coarse).array() + 0.5 * (coarse - 1);
        if (!inside(at) || nearest(at) < std::sqrt(0.75) * coarse) return;  // only blocks without solid cells
        int free = 0;
        for (const Vector3d& direction : towards) {
          bool hit = false;
          for (Vector3d q = at; inside(q);) {
            const double room = nearest(q);
            if ((hit = room < 0.5)) break;
            q += std::max(0.7, room - 1) * direction;
          }
          free += hit ? 0 : 1;
          if (free > (1 - hidden) * rays) return;
        }
        cave[static_cast<std::size_t>(b)] = 1;
      },
      64);
  for (int k = 0; k < grid.size.z(); ++k)
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i)
        if (cave[static_cast<std::size_t>(i / coarse) +
                 static_cast<std::size_t>(blocks.x()) *
                     (static_cast<std::size_t>(j / coarse) + static_cast<std::size_t>(blocks.y()) * (k / coarse))])
          solid[row(grid, i, j, k)] = 1;
}

double VoxelField::operator()(const Vector3d& p) const {
  const Vector3d last = grid_.size.cast<double>().array() - 1.000001;
  const Vector3d q = ((p - first_centre(grid_)) / grid_.spacing).cwiseMax(0.0).cwiseMin(last);
  const Eigen::Vector3i low = q.array().floor().cast<int>();
  const Vector3d t = q - low.cast<double>();
  double value = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
    value += (i ? t.x() : 1 - t.x()) * (j ? t.y() : 1 - t.y()) * (k ? t.z() : 1 - t.z()) *
             values_[row(grid_, low.x() + i, low.y() + j, low.z() + k)];
  }
  return value;
}

VoxelField signed_distance_field(const VoxelGrid& grid, const VoxelFlags& solid) {
  const std::vector<float> outside = distance_to(grid, solid), inside = distance_to(grid, inverted(solid));
  std::vector<float> values(solid.size());
  const auto half = static_cast<float>(0.5 * grid.spacing);
  for (std::size_t c = 0; c < values.size(); ++c) values[c] = solid[c] ? half - inside[c] : outside[c] - half;
  // Two passes of the binomial filter (1 2 1) / 4 along each axis.
  const std::array<std::size_t, 3> stride{1, static_cast<std::size_t>(grid.stride(1)),
                                          static_cast<std::size_t>(grid.stride(2))};
  for (int pass = 0; pass < 2; ++pass) {
    for (int axis = 0; axis < 3; ++axis) {
      const std::vector<float> before = values;
      parallel_for(
          grid.size.z(),
          [&](std::ptrdiff_t k) {
            for (int j = 0; j < grid.size.y(); ++j)
              for (int i = 0; i < grid.size.x(); ++i) {
                const int at = axis == 0 ? i : axis == 1 ? j : static_cast<int>(k);
                const std::size_t c = row(grid, i, j, static_cast<int>(k));
                const std::size_t low = at > 0 ? c - stride[axis] : c;
                const std::size_t high = at + 1 < grid.size[axis] ? c + stride[axis] : c;
                values[c] = 0.5F * before[c] + 0.25F * (before[low] + before[high]);
              }
          },
          1);
    }
  }
  return {grid, std::move(values)};
}

}  // namespace phiz
