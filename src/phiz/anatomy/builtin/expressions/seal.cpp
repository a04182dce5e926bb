// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/expressions/seal.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "phiz/anatomy/builtin/ease.h"
#include "phiz/anatomy/builtin/expressions/skin.h"

namespace phiz {
namespace {

constexpr double reach = 0.012;    ///< of the skin round the lips that follows, metres
constexpr double press = 0.00015;  ///< by which closed lips are nearer than at rest, metres
constexpr double alike = 0.0018;   ///< within which both lips move alike, metres

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

/// 1 upper, 2 lower, 3 both: the corners and the crease behind them; per vertex of head.skin.
std::vector<char> lip_sides(const HeadTemplate& head) {
  std::vector<char> side(static_cast<std::size_t>(head.skin.V.rows()), 0);
  for (const auto& [name, bit] :
       {std::pair{"upperLip", 1}, {"upperLipInner", 1}, {"lowerLip", 2}, {"lowerLipInner", 2}})
    if (const auto found = head.skin_regions.find(name); found != head.skin_regions.end())
      for (const int v : found->second) side[static_cast<std::size_t>(v)] |= static_cast<char>(bit);
  return side;
}

/// Lets both lips move alike where they lie against one another, in the corners too, where they are one; or, of lips
/// that part, in the corners only.
void join(const HeadTemplate& head, bool corners_only, MatrixX3d& displacement) {
  const std::vector<char> side = lip_sides(head);
  std::vector<int> seam, corners, upper, lower;
  for (const char* loop : {"loop:upperLipLine", "loop:lowerLipLine"})
    for (const int v : head.skin_regions.at(loop)) seam.push_back(v);
  for (int v = 0; v < head.skin.V.rows(); ++v) {
    const char own = side[static_cast<std::size_t>(v)];
    if ((own & 1) != 0) upper.push_back(v);
    if ((own & 2) != 0) lower.push_back(v);
    if (own == 3) corners.push_back(v);
  }
  seam.insert(seam.end(), corners.begin(), corners.end());
  const MatrixX3d line = head.skin.V(corners_only ? corners : seam, Eigen::all), before = displacement;
  const double half = line.col(0).cwiseAbs().maxCoeff();
  const auto mean = [&](const std::vector<int>& lip, const Vector3d& X) {
    Vector3d sum = Vector3d::Zero();
    double weights = 1e-12;
    for (const int v : lip) {
      const double squared = (head.skin.V.row(v).transpose() - X).squaredNorm();
      if (squared > 9 * alike * alike) continue;
      const double w = std::exp(-squared / (alike * alike));
      sum += w * before.row(v).transpose();
      weights += w;
    }
    return Vector3d(sum / weights);
  };
  for (int v = 0; v < head.skin.V.rows(); ++v) {
    const char own = side[static_cast<std::size_t>(v)];
    if (own == 0) continue;
    const Vector3d X = head.skin.V.row(v);
    const double distance = std::sqrt((line.rowwise() - X.transpose()).rowwise().squaredNorm().minCoeff());
    const double share = 1 - smoothstep(0.001, 0.006, distance), even = 1 - smoothstep(0.0005, 0.0025, distance);
    if (share <= 0) continue;
    const Vector3d above = mean(upper, X), below = mean(lower, X), both = 0.5 * (above + below);
    Vector3d d = before.row(v).transpose();
    if (own != 3) d += (own == 1 ? -0.5 : 0.5) * share * (above - below);
    displacement.row(v) = ((1 - even) * d + even * both).transpose();
    const double inside = 1 - smoothstep(0.6, 0.9, std::abs(X.x()) / half);
    if (own != 3 && !corners_only) displacement(v, 1) += (own == 1 ? -0.5 : 0.5) * share * inside * press;
  }
}

}  // namespace

void seal_lips(const HeadTemplate& head, MatrixX3d& displacement) {
  const MatrixX3d line = skin_curve(head, "loop:upperLipLine");
  const VectorXi &upper = head.skin_regions.at("loop:upperLipLine"), &lower = head.skin_regions.at("loop:lowerLipLine");
  const std::vector<char> side = lip_sides(head);
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
  join(head, false, displacement);
}

void join_corners(const HeadTemplate& head, MatrixX3d& displacement) {
  join(head, true, displacement);
}

}  // namespace phiz
