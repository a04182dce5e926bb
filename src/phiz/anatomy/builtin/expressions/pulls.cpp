// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/expressions/pulls.h"

#include <algorithm>
#include <cmath>

#include "phiz/anatomy/builtin/ease.h"
#include "phiz/anatomy/builtin/expressions/skin.h"
#include "phiz/core/error.h"

namespace phiz {
namespace {

constexpr double reach_distance = 0.012;  ///< metres
constexpr double pull_weight = 0.4;       ///< of a handle on the fibre at its insertion

VectorXd arc_lengths(const MatrixX3d& fibre) {
  VectorXd s(fibre.rows());
  s[0] = 0;
  for (Eigen::Index i = 1; i < s.size(); ++i) s[i] = s[i - 1] + (fibre.row(i) - fibre.row(i - 1)).norm();
  return s;
}

Vector3d point_at(const MatrixX3d& fibre, const VectorXd& arc, double along) {
  const double s = std::clamp(along, 0.0, 1.0) * arc[arc.size() - 1];
  Eigen::Index i = 0;
  while (i + 2 < arc.size() && arc[i + 1] < s) ++i;
  const double span = arc[i + 1] - arc[i], t = span > 0 ? (s - arc[i]) / span : 0;
  return ((1 - t) * fibre.row(i) + t * fibre.row(i + 1)).transpose();
}

std::string full_name(const ExpressionRecipe& recipe, std::string_view muscle,
                      const std::map<std::string, bool>& known) {
  std::string name(muscle);
  if (recipe.paired && !known.contains(name)) name += "Left";
  return name;
}

}  // namespace

MusclePulls::MusclePulls(const HeadTemplate& head, const std::vector<MuscleBundle>& muscles) : rest_(head.volume.V) {
  // A muscle that ends in one lip does not take the other one along, but for the corner where they meet.
  VectorXi lip = VectorXi::Zero(rest_.rows());
  const std::vector<char> upper = simulation_mask(head, {"upperLip", "upperLipInner"});
  const std::vector<char> lower = simulation_mask(head, {"lowerLip", "lowerLipInner"});
  const MatrixX3d line = skin_curve(head, "loop:upperLipLine");
  const double corner = 0.85 * line.col(0).cwiseAbs().maxCoeff(), parting = line.col(1).mean();
  for (std::size_t i = 0; i < upper.size(); ++i) {
    const int v = head.skin_vertices[static_cast<Eigen::Index>(i)];
    if (std::abs(rest_(v, 0)) < corner) lip[v] = upper[i] ? 1 : lower[i] ? -1 : 0;
  }
  for (const MuscleBundle& muscle : muscles) {
    Bundle bundle{muscle.fibres, {}, Vector3d::Zero(), false};
    if (bundle.fibres.empty()) continue;
    Eigen::AlignedBox3d box;
    std::vector<VectorXd> arcs;
    Eigen::Index points = 0;
    for (const MatrixX3d& fibre : bundle.fibres) {
      arcs.push_back(arc_lengths(fibre));
      for (Eigen::Index i = 0; i < fibre.rows(); ++i) box.extend(Vector3d(fibre.row(i)));
      bundle.centre += fibre.colwise().sum().transpose();
      points += fibre.rows();
    }
    bundle.centre /= static_cast<double>(points);
    const MatrixX3d& first = bundle.fibres.front();
    bundle.ring = (first.row(0) - first.row(first.rows() - 1)).norm() < 1e-9;
    const Vector3d end = first.row(first.rows() - 1);
    const int ends_in = bundle.ring || std::abs(end.x()) > corner ? 0 : end.y() > parting ? 1 : -1;
    const Eigen::AlignedBox3d reachable(box.min().array() - reach_distance, box.max().array() + reach_distance);
    for (int v = 0; v < rest_.rows(); ++v) {
      if (head.carrier[v] != static_cast<int>(Carrier::flesh)) continue;
      const Vector3d X = rest_.row(v);
      if (!reachable.contains(X) || lip[v] * ends_in < 0) continue;
      Reach best{v, -1, 0, 0};
      double distance = reach_distance * reach_distance;
      for (std::size_t f = 0; f < bundle.fibres.size(); ++f) {
        const FibrePoint near = nearest_on_fibre(bundle.fibres[f], X);
        if (near.squared_distance < distance) {
          const VectorXd& arc = arcs[f];
          const double before = arc[near.piece], after = arc[near.piece + 1];
          distance = near.squared_distance;
          best.fibre = static_cast<int>(f);
          best.along = (before + near.share * (after - before)) / arc[arc.size() - 1];
        }
      }
      if (best.fibre < 0) continue;
      best.weight = 1 - smoothstep(0.1 * reach_distance, reach_distance, std::sqrt(distance));
      bundle.reach.push_back(best);
    }
    bundles_.emplace(muscle.name, std::move(bundle));
  }
}

Pull MusclePulls::pull(const Bundle& bundle, const Reach& reach, double shortening) const {
  const MatrixX3d& fibre = bundle.fibres[static_cast<std::size_t>(reach.fibre)];
  const VectorXd arc = arc_lengths(fibre);
  const Vector3d here = point_at(fibre, arc, reach.along), X = rest_.row(reach.vertex);
  if (bundle.ring) {
    const Vector3d inward = (bundle.centre - here).cwiseProduct(Vector3d(1, 1, 0.3));
    return {reach.vertex, X + shortening * inward, inward.normalized()};
  }
  const Vector3d ahead = point_at(fibre, arc, reach.along + 0.05), behind = point_at(fibre, arc, reach.along - 0.05);
  return {reach.vertex, X + point_at(fibre, arc, reach.along * (1 - shortening)) - here, (ahead - behind).normalized()};
}

std::vector<Pull> MusclePulls::pulls(const ExpressionRecipe& recipe) const {
  std::map<std::string, bool> known;
  for (const auto& [name, bundle] : bundles_) known[name] = true;
  std::vector<Pull> result;
  for (const MusclePull& shortened : recipe.pulls) {
    const std::string name = full_name(recipe, shortened.muscle, known);
    const auto found = bundles_.find(name);
    if (found == bundles_.end())
      reject("expression '" + std::string(recipe.name) + "'", "the head has no muscle '" + name + "'");
    const Bundle& bundle = found->second;
    const double last = std::max<double>(1, static_cast<double>(bundle.fibres.size()) - 1);
    for (const Reach& reach : bundle.reach) {
      const Vector3d X = rest_.row(reach.vertex);
      // Active fibres, with a soft edge of a fifth of the width.
      const double fibre = reach.fibre / last;
      double active = smoothstep(shortened.from - 0.2, shortened.from, fibre) *
                      (1 - smoothstep(shortened.to, shortened.to + 0.2, fibre));
      if (shortened.part == MusclePull::Part::upper) active *= smoothstep(-0.003, 0.004, X.y() - bundle.centre.y());
      if (shortened.part == MusclePull::Part::lower) active *= smoothstep(-0.003, 0.004, bundle.centre.y() - X.y());
      if (shortened.part == MusclePull::Part::left) active *= smoothstep(-0.004, 0.003, X.x());
      // Held by the bone at the origin, by the skin at the insertion.
      const double grip = bundle.ring ? 1 : 0.15 + 0.85 * smoothstep(0, 0.8, reach.along);
      const double weight = pull_weight * reach.weight * active * grip;
      if (weight <= 1e-4) continue;
      result.push_back(pull(bundle, reach, shortened.shortening));
      result.back().weight = weight;
    }
  }
  return result;
}

}  // namespace phiz
