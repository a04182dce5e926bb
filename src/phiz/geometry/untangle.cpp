// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/geometry/untangle.h"

#include <vector>

#include "phiz/geometry/surface.h"
#include "phiz/geometry/topology.h"

namespace phiz {

bool untangle(TriangleMesh& mesh, int passes) {
  for (int pass = 0; pass < passes; ++pass) {
    const auto crossings = self_intersections(mesh);
    if (crossings.empty()) return true;
    const auto neighbours = vertex_neighbours(mesh.F, static_cast<int>(mesh.V.rows()));
    std::vector<char> moving(mesh.V.rows(), 0);
    for (const auto& [a, b] : crossings) {
      for (int k = 0; k < 3; ++k) moving[mesh.F(a, k)] = moving[mesh.F(b, k)] = 1;
    }
    for (int ring = 0; ring < pass / 5; ++ring) {
      const std::vector<char> core = moving;
      for (std::size_t v = 0; v < core.size(); ++v) {
        if (!core[v]) continue;
        for (const int w : neighbours[v]) moving[w] = 1;
      }
    }
    const MatrixX3d before = mesh.V;
    for (std::size_t v = 0; v < moving.size(); ++v) {
      if (!moving[v]) continue;
      Vector3d mean = Vector3d::Zero();
      for (const int w : neighbours[v]) mean += before.row(w).transpose();
      mesh.V.row(v) = 0.4 * before.row(v) + 0.6 / static_cast<double>(neighbours[v].size()) * mean.transpose();
    }
  }
  return self_intersections(mesh).empty();
}

}  // namespace phiz
