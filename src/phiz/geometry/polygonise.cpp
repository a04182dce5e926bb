// SPDX-License-Identifier: GPL-3.0-or-later
#include <spdlog/fmt/fmt.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/geometry/remesh.h"

namespace phiz {

namespace {

using Field = std::function<double(const Vector3d&)>;
using Cell = std::array<int, 3>;

constexpr int block_size = 8;  // lattice cells per side of a block that is skipped as a whole

/// Body-centred lattice: corner points (i, j, k) and the centres of the cells between them.
class Lattice {
 public:
  Lattice(const Box& box, double spacing) : low_(box.low), spacing_(spacing) {
    for (int k = 0; k < 3; ++k) {
      cells_[k] = std::max(1, static_cast<int>(std::ceil((box.high[k] - box.low[k]) / spacing)));
      blocks_[k] = (cells_[k] + block_size - 1) / block_size;
    }
    corners_ = static_cast<std::int64_t>(cells_[0] + 1) * (cells_[1] + 1) * (cells_[2] + 1);
    centres_ = static_cast<std::int64_t>(cells_[0]) * cells_[1] * cells_[2];
  }

  const Cell& cells() const { return cells_; }
  const Cell& blocks() const { return blocks_; }
  double spacing() const { return spacing_; }
  std::int64_t point_count() const { return corners_ + centres_; }

  std::int64_t corner(int i, int j, int k) const {
    return (static_cast<std::int64_t>(k) * (cells_[1] + 1) + j) * (cells_[0] + 1) + i;
  }
  std::int64_t centre(int i, int j, int k) const {
    return corners_ + (static_cast<std::int64_t>(k) * cells_[1] + j) * cells_[0] + i;
  }
  Vector3d position(std::int64_t point) const {
    const bool is_corner = point < corners_;
    const int extra = is_corner ? 1 : 0;
    const std::int64_t n = is_corner ? point : point - corners_;
    const std::int64_t nx = cells_[0] + extra, ny = cells_[1] + extra;
    const std::int64_t x = n % nx, y = (n / nx) % ny, z = n / (nx * ny);
    const Vector3d index(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
    return low_ + spacing_ * (index + Vector3d::Constant(is_corner ? 0.0 : 0.5));
  }

 private:
  Vector3d low_;
  double spacing_;
  Cell cells_{}, blocks_{};
  std::int64_t corners_, centres_;
};

/// Values of f on the lattice; points of skipped blocks hold the value of their block's centre, which has the right
/// sign.
std::vector<double> sample(const Field& f, const Lattice& lattice, double lipschitz) {
  std::vector<double> values(static_cast<std::size_t>(lattice.point_count()));
  const Cell& blocks = lattice.blocks();
  const Cell& cells = lattice.cells();
  const double reach = 0.5 * std::sqrt(3.0) * lattice.spacing() * (block_size + 1);
  parallel_for(
      static_cast<std::ptrdiff_t>(blocks[0]) * blocks[1] * blocks[2],
      [&](std::ptrdiff_t block) {
        const Cell at{static_cast<int>(block % blocks[0]), static_cast<int>(block / blocks[0] % blocks[1]),
                      static_cast<int>(block / (static_cast<std::ptrdiff_t>(blocks[0]) * blocks[1]))};
        Cell begin, end;
        for (std::size_t k = 0; k < 3; ++k) {
          begin[k] = at[k] * block_size;
          end[k] = std::min(cells[k], begin[k] + block_size);
        }
        const Vector3d middle = lattice.position(lattice.corner(begin[0], begin[1], begin[2])) +
                                Vector3d::Constant(0.5 * block_size * lattice.spacing());
        double whole = 0;
        bool skip = false;
        if (lipschitz > 0) {
          whole = f(middle);
          skip = std::abs(whole) > lipschitz * reach;
        }
        const auto set = [&](std::int64_t point) {
          values[static_cast<std::size_t>(point)] = skip ? whole : f(lattice.position(point));
        };
        // A block owns the corners at its low side; the last block of a row also those at the high side.
        Cell last;
        for (std::size_t k = 0; k < 3; ++k) last[k] = end[k] + (end[k] == cells[k] ? 1 : 0);
        for (int k = begin[2]; k < last[2]; ++k)
          for (int j = begin[1]; j < last[1]; ++j)
            for (int i = begin[0]; i < last[0]; ++i) {
              set(lattice.corner(i, j, k));
              if (i < end[0] && j < end[1] && k < end[2]) set(lattice.centre(i, j, k));
            }
      },
      1);
  return values;
}

/// Collects the triangles where the sign changes.
class Marcher {
 public:
  Marcher(const Lattice& lattice, const std::vector<double>& values) : lattice_(lattice), values_(values) {}

  /// The tet's corners in any order.
  void add_tet(std::array<std::int64_t, 4> p) {
    int inside = 0;
    for (const auto q : p) inside += is_inside(q) ? 1 : 0;
    if (inside == 0 || inside == 4) return;
    std::stable_partition(p.begin(), p.end(), [this](std::int64_t q) { return is_inside(q); });
    // Make the tet positive, swapping corners of the same side only.
    if (volume_sign(p) < 0) inside >= 2 ? std::swap(p[0], p[1]) : std::swap(p[2], p[3]);
    if (inside == 1) {
      add_triangle(cut(p[0], p[1]), cut(p[0], p[2]), cut(p[0], p[3]));
    } else if (inside == 3) {
      add_triangle(cut(p[0], p[3]), cut(p[1], p[3]), cut(p[2], p[3]));
    } else {
      const int a = cut(p[0], p[2]), b = cut(p[0], p[3]), c = cut(p[1], p[3]), d = cut(p[1], p[2]);
      add_triangle(a, b, c);
      add_triangle(a, c, d);
    }
  }

  TriangleMesh result() const {
    TriangleMesh mesh;
    mesh.V.resize(static_cast<Eigen::Index>(points_.size()), 3);
    for (std::size_t i = 0; i < points_.size(); ++i) mesh.V.row(static_cast<Eigen::Index>(i)) = points_[i];
    mesh.F.resize(static_cast<Eigen::Index>(triangles_.size()), 3);
    for (std::size_t i = 0; i < triangles_.size(); ++i) mesh.F.row(static_cast<Eigen::Index>(i)) = triangles_[i];
    return mesh;
  }

 private:
  bool is_inside(std::int64_t p) const { return values_[static_cast<std::size_t>(p)] < 0; }

  double volume_sign(const std::array<std::int64_t, 4>& p) const {
    const Vector3d o = lattice_.position(p[0]);
    return (lattice_.position(p[1]) - o).cross(lattice_.position(p[2]) - o).dot(lattice_.position(p[3]) - o);
  }

  int cut(std::int64_t inside, std::int64_t outside) {
    const auto low = std::min(inside, outside), high = std::max(inside, outside);
    const auto key = static_cast<std::uint64_t>(low) * static_cast<std::uint64_t>(lattice_.point_count()) +
                     static_cast<std::uint64_t>(high);
    const auto [it, added] = vertex_of_.emplace(key, static_cast<int>(points_.size()));
    if (added) {
      const double a = values_[static_cast<std::size_t>(inside)], b = values_[static_cast<std::size_t>(outside)];
      const double t = std::clamp(a / (a - b), 0.05, 0.95);
      points_.push_back((1 - t) * lattice_.position(inside) + t * lattice_.position(outside));
    }
    return it->second;
  }

  void add_triangle(int a, int b, int c) { triangles_.emplace_back(a, b, c); }

  const Lattice& lattice_;
  const std::vector<double>& values_;
  std::unordered_map<std::uint64_t, int> vertex_of_;
  std::vector<Vector3d> points_;
  std::vector<Eigen::Vector3i> triangles_;
};

TriangleMesh march(const Lattice& lattice, const std::vector<double>& values) {
  Marcher marcher(lattice, values);
  const Cell& n = lattice.cells();
  // Four tets round every face between two cells: the two centres and one side of the face.
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i)
        for (int axis = 0; axis < 3; ++axis) {
          Cell next{i, j, k};
          if (++next[static_cast<std::size_t>(axis)] >= n[static_cast<std::size_t>(axis)]) continue;
          std::array<std::int64_t, 4> ring;
          for (int corner = 0; corner < 4; ++corner) {
            Cell at = next;
            const auto u = static_cast<std::size_t>((axis + 1) % 3), v = static_cast<std::size_t>((axis + 2) % 3);
            at[u] += corner == 1 || corner == 2 ? 1 : 0;
            at[v] += corner >= 2 ? 1 : 0;
            ring[static_cast<std::size_t>(corner)] = lattice.corner(at[0], at[1], at[2]);
          }
          for (std::size_t corner = 0; corner < 4; ++corner)
            marcher.add_tet({lattice.centre(i, j, k), lattice.centre(next[0], next[1], next[2]), ring[corner],
                             ring[(corner + 1) % 4]});
        }
  return marcher.result();
}

/// Refuses values that are not finite and insides that reach the outermost two layers, which the tets do not cover.
void check(const Lattice& lattice, const std::vector<double>& values) {
  bool any = false;
  const Cell& n = lattice.cells();
  for (std::size_t p = 0; p < values.size(); ++p) {
    if (!std::isfinite(values[p])) {
      const Vector3d x = lattice.position(static_cast<std::int64_t>(p));
      reject("polygonise", fmt::format("the function is not finite at ({}, {}, {})", x[0], x[1], x[2]));
    }
    any = any || values[p] < 0;
  }
  if (!any)
    reject("polygonise", "the function is nowhere negative in the box",
           "move or enlarge the box, or use a finer lattice");
  const auto require_outside = [&](std::int64_t point) {
    if (values[static_cast<std::size_t>(point)] >= 0) return;
    const Vector3d x = lattice.position(point);
    reject("polygonise",
           fmt::format("the shape reaches the side of the box at ({:.4g}, {:.4g}, {:.4g})", x[0], x[1], x[2]),
           "enlarge the box");
  };
  for (int k = 0; k <= n[2]; ++k)
    for (int j = 0; j <= n[1]; ++j)
      for (int i = 0; i <= n[0]; ++i) {
        if (i == 0 || i == n[0] || j == 0 || j == n[1] || k == 0 || k == n[2]) require_outside(lattice.corner(i, j, k));
        if (i < n[0] && j < n[1] && k < n[2] &&
            (i == 0 || i == n[0] - 1 || j == 0 || j == n[1] - 1 || k == 0 || k == n[2] - 1))
          require_outside(lattice.centre(i, j, k));
      }
}

/// Newton steps along the gradient (central differences), each at most `reach` long; kept only while |f| falls.
void project(const Field& f, MatrixX3d& V, double reach, int steps) {
  const double h = 1e-3 * reach;
  parallel_for(
      V.rows(),
      [&](Eigen::Index v) {
        Vector3d x = V.row(v);
        double value = f(x);
        for (int step = 0; step < steps && value != 0; ++step) {
          Vector3d gradient;
          for (int k = 0; k < 3; ++k) {
            Vector3d side = Vector3d::Zero();
            side[k] = h;
            gradient[k] = (f(x + side) - f(x - side)) / (2 * h);
          }
          const double squared = gradient.squaredNorm();
          if (!(squared > 1e-12)) break;
          Vector3d move = -value / squared * gradient;
          move *= std::min(1.0, reach / std::max(move.norm(), 1e-300));
          const double after = f(x + move);
          if (!(std::abs(after) < std::abs(value))) break;
          x += move;
          value = after;
        }
        V.row(v) = x;
      },
      64);
}

}  // namespace

TriangleMesh polygonise(const Field& f, const Box& box, const PolygoniseOptions& options) {
  if (!(options.edge_length > 0)) throw Error(ErrorKind::usage, "polygonise needs a positive edge length");
  if (!((box.high - box.low).minCoeff() > 0) || !box.low.allFinite() || !box.high.allFinite())
    reject("polygonise", "the box is empty or not finite");
  const Lattice lattice(box, options.edge_length * 1.2);
  if (lattice.point_count() > 200'000'000)
    reject("polygonise", fmt::format("the lattice would have {} points", lattice.point_count()),
           "use a longer edge or a smaller box");
  const std::vector<double> values = sample(f, lattice, options.lipschitz);
  check(lattice, values);
  TriangleMesh mesh = march(lattice, values);
  const double reach = 0.3 * options.edge_length;
  project(f, mesh.V, reach, options.projection_steps);
  if (options.improve) {
    RemeshOptions remesh;
    remesh.edge_length = options.edge_length;
    remesh.iterations = 4;
    mesh = remesh_isotropic(mesh, remesh);
    project(f, mesh.V, reach, options.projection_steps);
  }
  return mesh;
}

}  // namespace phiz
