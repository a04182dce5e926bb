// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/people/reshaped_expressions.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <string>

#include "phiz/core/parallel.h"

namespace phiz {

namespace {

/// Stretches a blink (`e`, already turned to the person) so that the upper lid's margin comes as near to the lower one
/// on the whole, or as far past it, as it does in the head: openings of eyes differ more than a smooth gradient tells.
void meet_lids(const HeadTemplate& head, const Expression& before, const MatrixX3d& skin, const std::string& side,
               Expression& e) {
  const auto upper = head.skin_regions.find(side + "UpperLidMargin");
  const auto lower = head.skin_regions.find(side + "LowerLidMargin");
  if (upper == head.skin_regions.end() || lower == head.skin_regions.end() || lower->second.size() == 0) return;
  const MatrixX3d closed = head.skin.V + before.displacement, now = skin + e.displacement;
  double lacking = 0, closing = 0;
  for (const int u : upper->second) {
    const Vector3d d = e.displacement.row(u);
    int nearest = lower->second[0];
    for (const int l : lower->second)
      if ((closed.row(u) - closed.row(l)).squaredNorm() < (closed.row(u) - closed.row(nearest)).squaredNorm())
        nearest = l;
    const Vector3d wanted = closed.row(u) - closed.row(nearest), is = now.row(u) - now.row(nearest);
    lacking += (wanted - is).dot(d);
    closing += d.squaredNorm();
  }
  constexpr double most = 0.4;
  if (closing > 0) e.displacement *= 1 + std::clamp(lacking / closing, -most, most);
}

}  // namespace

std::vector<Matrix3d> local_gradients(const MatrixX3d& points, const MatrixX3d& displacement, const MatrixX3d& at,
                                      double reach) {
  constexpr double farthest = 3;    // in units of `reach`
  constexpr double damping = 0.03;  // of the spread along the surface: what is flat has no gradient across
  std::vector<Matrix3d> gradients(static_cast<std::size_t>(at.rows()));
  parallel_for(
      at.rows(),
      [&](Eigen::Index i) {
        const Vector3d p = at.row(i);
        double total = 0;
        Vector3d x = Vector3d::Zero(), d = Vector3d::Zero();
        Matrix3d xx = Matrix3d::Zero(), dx = Matrix3d::Zero();
        for (Eigen::Index j = 0; j < points.rows(); ++j) {
          const Vector3d q = points.row(j).transpose() - p;
          const double square = q.squaredNorm() / (reach * reach);
          if (square > farthest * farthest) continue;
          const double w = std::exp(-0.5 * square);
          const Vector3d u = displacement.row(j);
          total += w;
          x += w * q;
          d += w * u;
          xx += w * q * q.transpose();
          dx += w * u * q.transpose();
        }
        Matrix3d& gradient = gradients[static_cast<std::size_t>(i)];
        gradient.setIdentity();
        if (total <= 0) return;
        xx -= x * x.transpose() / total;
        dx -= d * x.transpose() / total;
        xx.diagonal().array() += damping * xx.trace() + 1e-12;
        gradient += xx.ldlt().solve(dx.transpose()).transpose();
      },
      64);
  return gradients;
}

std::vector<Expression> reshaped_expressions(const HeadTemplate& head, const MatrixX3d& skin, const JawJoint& joint) {
  constexpr double reach = 0.005;  // about half of an eye's opening
  const MatrixX3d& rest = head.skin.V;
  const std::vector<Matrix3d> gradients =
      local_gradients(head.skin_sampling * rest, head.skin_sampling * (skin - rest), rest, reach);
  std::vector<Expression> expressions = head.expressions;
  for (std::size_t i = 0; i < expressions.size(); ++i) {
    Expression& e = expressions[i];
    const Eigen::Isometry3d before = jaw_transform(head.jaw, e.jaw), after = jaw_transform(joint, e.jaw);
    constexpr double still = 1e-6;  // metres squared: near the axis the jaw moves nothing
    for (Eigen::Index v = 0; v < rest.rows(); ++v) {
      const Vector3d d = e.displacement.row(v);
      if (d.isZero(0)) continue;
      const Vector3d p = rest.row(v), q = skin.row(v);
      const Vector3d by_jaw = before * p - p;
      const double share = std::clamp(d.dot(by_jaw) / (by_jaw.squaredNorm() + still), 0.0, 1.0);
      e.displacement.row(v) = share * (after * q - q) + gradients[static_cast<std::size_t>(v)] * (d - share * by_jaw);
    }
    if (e.name == "eyeBlinkLeft") meet_lids(head, head.expressions[i], skin, "left", e);
    if (e.name == "eyeBlinkRight") meet_lids(head, head.expressions[i], skin, "right", e);
  }
  return expressions;
}

}  // namespace phiz
