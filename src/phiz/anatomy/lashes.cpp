// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/lashes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "phiz/core/random.h"
#include "phiz/geometry/surface.h"

namespace phiz {

namespace {

constexpr int segments = 6, sides = 3;

Vector3d on_line(const MatrixX3d& line, double along) {
  const double at = std::clamp(along, 0.0, 1.0) * static_cast<double>(line.rows() - 1);
  const auto k = std::min<Eigen::Index>(static_cast<Eigen::Index>(at), line.rows() - 2);
  const double t = at - static_cast<double>(k);
  return (1 - t) * line.row(k) + t * line.row(k + 1);
}

/// `depth` 0 at the roots, 1 at the tips.
Vector3d on_sheet(const LashSheet& sheet, double along, double depth) {
  const double at = std::clamp(depth, 0.0, 1.0) * static_cast<double>(sheet.size() - 1);
  const auto k = std::min(static_cast<std::size_t>(at), sheet.size() - 2);
  const double t = at - static_cast<double>(k);
  return (1 - t) * on_line(sheet[k], along) + t * on_line(sheet[k + 1], along);
}

/// A tube round a line, closed at the root and pointed at the tip.
TriangleMesh tube(const MatrixX3d& line, double radius) {
  constexpr double tip = 0.25, tau = 6.283185307179586;
  TriangleMesh mesh;
  const Eigen::Index rings = line.rows() - 1;
  mesh.V.resize(rings * sides + 1, 3);
  const Vector3d whole = line.bottomRows(1).transpose() - line.topRows(1).transpose();
  const Vector3d across = whole.unitOrthogonal();
  for (Eigen::Index r = 0; r < rings; ++r) {
    const Vector3d along = (line.row(r + 1) - line.row(std::max<Eigen::Index>(r - 1, 0))).normalized();
    const Vector3d u = (across - across.dot(along) * along).normalized(), v = along.cross(u);
    const double t = static_cast<double>(r) / static_cast<double>(rings), width = radius * (1 - (1 - tip) * t * t);
    for (int k = 0; k < sides; ++k)
      mesh.V.row(r * sides + k) =
          line.row(r).transpose() + width * (std::cos(tau * k / sides) * u + std::sin(tau * k / sides) * v);
  }
  mesh.V.bottomRows(1) = line.bottomRows(1);
  mesh.F.resize(2 * sides * (rings - 1) + sides + 1, 3);
  const auto at = [](Eigen::Index ring, int k) { return static_cast<int>(ring) * sides + k % sides; };
  Eigen::Index f = 0;
  for (Eigen::Index r = 0; r + 1 < rings; ++r)
    for (int k = 0; k < sides; ++k) {
      mesh.F.row(f++) << at(r, k), at(r, k + 1), at(r + 1, k);
      mesh.F.row(f++) << at(r, k + 1), at(r + 1, k + 1), at(r + 1, k);
    }
  for (int k = 0; k < sides; ++k)
    mesh.F.row(f++) << at(rings - 1, k), at(rings - 1, k + 1), static_cast<int>(mesh.V.rows()) - 1;
  mesh.F.row(f++) << 2, 1, 0;
  return mesh;
}

void add_hairs(const std::vector<LashSheet>& sheets, int count, Random& random, std::vector<TriangleMesh>& lashes) {
  constexpr double radius = 0.00006, shortest = 0.62, per_tuft = 3.5;  // metres; of the sheet's depth; lashes
  for (int i = 0; i < count; ++i) {
    const LashSheet& sheet = sheets[static_cast<std::size_t>(i) % sheets.size()];
    const double along = (i + random.uniform(0.1, 0.9)) / count;
    const double tuft = (std::floor(along * count / per_tuft) + 0.5) * per_tuft / count;
    const double reach = random.uniform(shortest, 1.0), lean = 0.45 * (tuft - along) + random.normal() * 0.008;
    MatrixX3d line(segments + 1, 3);
    for (int k = 0; k <= segments; ++k) {
      const double t = static_cast<double>(k) / segments;
      line.row(k) = on_sheet(sheet, along + lean * t * t, reach * t);
    }
    lashes.push_back(tube(line, radius * random.uniform(0.75, 1.15)));
  }
}

}  // namespace

LashSheet lash_sheet(const MatrixX3d& margin, const Vector3d& eye_centre, bool upper) {
  constexpr int rows = 6;
  const double longest = upper ? 0.0088 : 0.0052;  // metres
  const double up = upper ? 1 : -1;
  const Vector3d inner = margin.row(0), outer = margin.row(margin.rows() - 1);
  LashSheet sheet(rows, MatrixX3d(margin.rows(), 3));
  for (Eigen::Index i = 0; i < margin.rows(); ++i) {
    const Vector3d root = margin.row(i);
    const double along = (root - inner).dot(outer - inner) / (outer - inner).squaredNorm();
    // They stand off the eye, fan out beside it, and are shortest at the inner corner.
    Vector3d away = (root - eye_centre).normalized();
    away = (away + 0.75 * (along - 0.45) * (outer - inner).normalized()).normalized();
    const Vector3d rise = (Vector3d(0, up, 0) - up * away.y() * away).normalized();
    const double length = longest * (0.45 + 0.55 * std::sin(std::clamp(0.15 + 0.95 * along, 0.0, 1.0) * 2.2));
    for (int k = 0; k < rows; ++k) {
      const double t = k / (rows - 1.0);
      sheet[static_cast<std::size_t>(k)].row(i) =
          root + length * (0.9 * t * away + (upper ? 0.72 * t * t - 0.12 * t : 0.62 * t - 0.15 * t * t) * rise);
    }
  }
  return sheet;
}

TriangleMesh grow_lashes(const std::vector<LashSheet>& upper, const std::vector<LashSheet>& lower, std::uint64_t seed) {
  Random random(seed);
  std::vector<TriangleMesh> lashes;
  add_hairs(upper, 120, random, lashes);
  add_hairs(lower, 75, random, lashes);
  return joined(lashes);
}

}  // namespace phiz
