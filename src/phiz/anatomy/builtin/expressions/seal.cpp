// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/expressions/seal.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "phiz/anatomy/builtin/ease.h"
#include "phiz/anatomy/builtin/expressions/skin.h"

namespace phiz {
namespace {

constexpr double reach = 0.012;  ///< of the skin round the lips that follows, metres

/// How far up the point of the line `loop` at `x` moves, metres.
double rise(const HeadTemplate& head, const VectorXi& loop, const MatrixX3d& displacement, double x) {
  double sum = 0, weights = 0;
  for (const int v : loop) {
    const double w = std::exp(-std::pow((head.skin.V(v, 0) - x) / 0.0012, 2)) + 1e-12;
    sum += w * displacement(v, 1);
    weights += w;
  }
  return sum / weights;
}

}  // namespace

void seal_lips(const HeadTemplate& head, MatrixX3d& displacement) {
  const MatrixX3d line = skin_curve(head, "loop:upperLipLine");
  const VectorXi &upper = head.skin_regions.at("loop:upperLipLine"), &lower = head.skin_regions.at("loop:lowerLipLine");
  std::vector<char> side(static_cast<std::size_t>(head.skin.V.rows()), 0);  // 1 upper, 2 lower, 3 both: the corners
  for (const auto& [name, bit] :
       {std::pair{"upperLip", 1}, {"upperLipInner", 1}, {"lowerLip", 2}, {"lowerLipInner", 2}})
    if (const auto found = head.skin_regions.find(name); found != head.skin_regions.end())
      for (const int v : found->second) side[static_cast<std::size_t>(v)] |= static_cast<char>(bit);
  const MatrixX3d before = displacement;
  for (Eigen::Index v = 0; v < before.rows(); ++v) {
    const Vector3d X = head.skin.V.row(v);
    Eigen::Index nearest = 0;
    const double squared = (line.rowwise() - X.transpose()).rowwise().squaredNorm().minCoeff(&nearest);
    const char own = side[static_cast<std::size_t>(v)];
    if (squared > reach * reach || own == 3) continue;
    const double gap = rise(head, upper, before, X.x()) - rise(head, lower, before, X.x());
    if (gap <= 0) continue;
    const bool above = own != 0 ? own == 1 : X.y() > line(nearest, 1);
    const double share = 0.5 * (1 - smoothstep(0.001, reach, std::sqrt(squared)));
    displacement(v, 1) += above ? -share * gap : share * gap;
  }
}

}  // namespace phiz
