// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/geometry/geodesic.h"

#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "phiz/geometry/topology.h"

namespace phiz {

VectorXd edge_distances(const MatrixX3d& V, const MatrixX3i& F, std::span<const int> sources) {
  const auto neighbours = vertex_neighbours(F, static_cast<int>(V.rows()));
  VectorXd distance = VectorXd::Constant(V.rows(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  for (const int s : sources) {
    distance[s] = 0;
    open.emplace(0, s);
  }
  while (!open.empty()) {
    const auto [d, v] = open.top();
    open.pop();
    if (d > distance[v]) continue;
    for (const int w : neighbours[static_cast<std::size_t>(v)]) {
      const double through = d + (V.row(w) - V.row(v)).norm();
      if (through >= distance[w]) continue;
      distance[w] = through;
      open.emplace(through, w);
    }
  }
  return distance;
}

}  // namespace phiz
