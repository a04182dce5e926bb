// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/expressions/mirror.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace phiz {

VectorXi mirror_partners(const MatrixX3d& V) {
  std::vector<int> by_height(static_cast<std::size_t>(V.rows()));
  std::iota(by_height.begin(), by_height.end(), 0);
  std::sort(by_height.begin(), by_height.end(), [&](int a, int b) { return V(a, 1) < V(b, 1); });
  VectorXi partner(V.rows());
  for (int v = 0; v < V.rows(); ++v) {
    const Vector3d wanted(-V(v, 0), V(v, 1), V(v, 2));
    int best = v;
    double least = 1e30;
    const auto start =
        std::lower_bound(by_height.begin(), by_height.end(), wanted.y(), [&](int a, double y) { return V(a, 1) < y; });
    const auto look = [&](int candidate) {
      const double d = (V.row(candidate).transpose() - wanted).squaredNorm();
      if (d < least) {
        least = d;
        best = candidate;
      }
    };
    for (auto up = start; up != by_height.end() && std::pow(V(*up, 1) - wanted.y(), 2) < least; ++up) look(*up);
    for (auto down = start; down != by_height.begin();) {
      --down;
      if (std::pow(V(*down, 1) - wanted.y(), 2) >= least) break;
      look(*down);
    }
    partner[v] = best;
  }
  return partner;
}

MatrixX3d reflected(const MatrixX3d& D, const VectorXi& partner) {
  MatrixX3d result = D(partner, Eigen::all);
  result.col(0) *= -1;
  return result;
}

}  // namespace phiz
