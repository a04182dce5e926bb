// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/face/lid_closing.h"

#include <cmath>
#include <utility>
#include <vector>

namespace phiz {

namespace {

/// Vertices of the upper margin, in the middle half of its width, with those of the lower one below them.
std::vector<std::pair<int, int>> facing(const MatrixX3d& V, const VectorXi& upper, const VectorXi& lower) {
  std::vector<std::pair<int, int>> pairs;
  if (upper.size() == 0 || lower.size() == 0) return pairs;
  const double low = V(upper, 0).minCoeff(), quarter = (V(upper, 0).maxCoeff() - low) / 4;
  for (const int u : upper) {
    if (std::abs(V(u, 0) - low - 2 * quarter) > quarter) continue;
    int below = lower[0];
    for (const int l : lower)
      if (std::abs(V(l, 0) - V(u, 0)) < std::abs(V(below, 0) - V(u, 0))) below = l;
    pairs.emplace_back(u, below);
  }
  return pairs;
}

}  // namespace

VectorXd lid_closing(const HeadTemplate& head, const std::string& side) {
  const auto upper = head.skin_regions.find(side + "UpperLidMargin");
  const auto lower = head.skin_regions.find(side + "LowerLidMargin");
  const Expression* blink = find_expression(head, side == "left" ? "eyeBlinkLeft" : "eyeBlinkRight");
  if (upper == head.skin_regions.end() || lower == head.skin_regions.end() || blink == nullptr) return {};
  const MatrixX3d& V = head.skin.V;
  const auto pairs = facing(V, upper->second, lower->second);
  const auto closing = [&](const Expression& e) {
    double sum = 0;
    for (const auto& [u, l] : pairs)
      sum += (e.displacement.row(l) - e.displacement.row(u)).dot((V.row(u) - V.row(l)).normalized());
    return sum;
  };
  const double whole = closing(*blink);
  if (!(whole > 0)) return {};
  VectorXd shares(static_cast<Eigen::Index>(head.expressions.size()));
  for (Eigen::Index e = 0; e < shares.size(); ++e)
    shares[e] = closing(head.expressions[static_cast<std::size_t>(e)]) / whole;
  return shares;
}

}  // namespace phiz
