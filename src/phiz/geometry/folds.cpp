// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/geometry/folds.h"

#include <Eigen/Geometry>
#include <set>

#include "phiz/core/parallel.h"
#include "phiz/geometry/topology.h"

namespace phiz {

namespace {

constexpr int narrow_rounds = 10, most_rounds = 40;
constexpr std::ptrdiff_t grain = 2048;

}  // namespace

FoldMender::FoldMender(const TriangleMesh& rest, const std::vector<char>& vertices, double least)
    : F_(rest.F), least_(least) {
  std::vector<int> place(static_cast<std::size_t>(F_.rows()), -1);
  for (int f = 0; f < F_.rows(); ++f)
    for (const int v : F_.row(f))
      if (vertices[static_cast<std::size_t>(v)] && place[static_cast<std::size_t>(f)] < 0) {
        place[static_cast<std::size_t>(f)] = static_cast<int>(watched_.size());
        watched_.push_back(f);
      }
  neighbours_ = vertex_neighbours(F_, static_cast<int>(rest.V.rows()));
  const MatrixX3i across = triangle_neighbours(F_);
  const Eigen::Matrix3Xd normals = unit_normals(rest.V);
  for (int i = 0; i < static_cast<int>(watched_.size()); ++i)
    for (const int g : across.row(watched_[static_cast<std::size_t>(i)])) {
      const int j = g < 0 ? -1 : place[static_cast<std::size_t>(g)];
      if (j > i && normals.col(i).dot(normals.col(j)) > 0) across_.emplace_back(i, j);
    }
}

Eigen::Matrix3Xd FoldMender::unit_normals(const MatrixX3d& V) const {
  Eigen::Matrix3Xd normals(3, static_cast<Eigen::Index>(watched_.size()));
  parallel_for(
      normals.cols(),
      [&](std::ptrdiff_t i) {
        const int f = watched_[static_cast<std::size_t>(i)];
        const Vector3d a = V.row(F_(f, 0)), b = V.row(F_(f, 1)), c = V.row(F_(f, 2));
        normals.col(i) = (b - a).cross(c - a).normalized();
      },
      grain);
  return normals;
}

std::vector<std::pair<int, int>> FoldMender::folded(const MatrixX3d& V) const {
  const Eigen::Matrix3Xd normals = unit_normals(V);
  std::vector<std::pair<int, int>> pairs;
  for (const auto& [i, j] : across_)
    if (normals.col(i).dot(normals.col(j)) < least_)
      pairs.emplace_back(watched_[static_cast<std::size_t>(i)], watched_[static_cast<std::size_t>(j)]);
  return pairs;
}

int FoldMender::mend(MatrixX3d& V) const {
  std::vector<std::pair<int, int>> pairs = folded(V);
  for (int round = 0; round < most_rounds && !pairs.empty(); ++round) {
    std::set<int> touched;
    for (const auto& [f, g] : pairs)
      for (const int triangle : {f, g})
        for (const int v : F_.row(triangle)) {
          touched.insert(v);
          const auto& ring = neighbours_[static_cast<std::size_t>(v)];
          if (round >= narrow_rounds) touched.insert(ring.begin(), ring.end());
        }
    const MatrixX3d before = V;
    for (const int v : touched) {
      const MatrixX3d others = before(neighbours_[static_cast<std::size_t>(v)], Eigen::all);
      V.row(v) = 0.5 * before.row(v) + 0.5 * others.colwise().mean();
    }
    pairs = folded(V);
  }
  return static_cast<int>(pairs.size());
}

}  // namespace phiz
