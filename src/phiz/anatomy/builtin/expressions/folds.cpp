// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/expressions/folds.h"

#include <algorithm>
#include <cmath>

#include "phiz/anatomy/builtin/ease.h"
#include "phiz/anatomy/builtin/expressions/skin.h"
#include "phiz/geometry/surface.h"

namespace phiz {
namespace {

constexpr double mm = 1e-3;

/// A crease along a line of the left half as seen from the front, from its upper end down.
struct Crease {
  std::vector<Vector2d> line;
  double width;   ///< of the dip
  double beside;  ///< where the flesh that is gathered stands out, lateral of the line
  double spread;  ///< of that flesh
  double gather;  ///< its height as a share of the dip's depth
};

/// Height at p per unit of depth. Where p lies along and across of the line is a mean over the pieces of the line with
/// more weight on the near ones: the nearest piece alone would jump inside of a bend.
double height(const Crease& crease, const Vector2d& p) {
  constexpr double piece = 1 * mm, softness = 5 * mm;
  double total = 0, along = 0, across = 0, length = 0;
  for (std::size_t i = 0; i + 1 < crease.line.size(); ++i) {
    const Vector2d a = crease.line[i], e = crease.line[i + 1] - a;
    const double n = std::ceil(e.norm() / piece);
    for (double t = 0.5 / n; t < 1; t += 1 / n) {
      const Vector2d from = p - (a + t * e);
      const double w = std::exp(-from.squaredNorm() / (softness * softness)) * e.norm() / n;
      total += w;
      along += w * (length + t * e.norm());
      across += w * (e.x() * from.y() - e.y() * from.x()) / e.norm();  // lateral of a line that runs down: positive
    }
    length += e.norm();
  }
  if (total < 1e-30) return 0;
  along /= total;
  across /= total;
  const double fade = smoothstep(0, 0.25 * length, along) * smoothstep(0, 0.3 * length, length - along);
  return fade * (crease.gather * std::exp(-std::pow((across - crease.beside) / crease.spread, 2)) -
                 std::exp(-std::pow(across / crease.width, 2)));
}

Crease nasolabial(const Proportions& p) {
  const Vector2d ala = p.alare.head<2>(), corner = p.cheilion.head<2>();
  const auto at = [&](double down, double aside) { return Vector2d(ala + down * (corner - ala) + Vector2d(aside, 0)); };
  return {{at(-0.03, 1.5 * mm), at(0.27, 1.4 * mm), at(0.56, 6.6 * mm), at(0.91, 11 * mm), at(1.24, 8.6 * mm)},
          2.8 * mm,
          8.5 * mm,
          6.5 * mm,
          0.9};
}

Crease marionette(const Proportions& p) {
  const Vector2d corner = p.cheilion.head<2>();
  const auto at = [&](double x, double y) { return Vector2d(corner + mm * Vector2d(x, y)); };
  return {{at(2.5, 4), at(4, -4), at(5.5, -14), at(5.5, -24)}, 2.6 * mm, 7 * mm, 5.5 * mm, 0.8};
}

Crease dimple(const Proportions& p) {
  const Vector2d corner = p.cheilion.head<2>();
  const auto at = [&](double x, double y) { return Vector2d(corner + mm * Vector2d(x, y)); };
  return {{at(8, 11), at(9, 4), at(9, -3), at(7.5, -10)}, 2.8 * mm, 6.5 * mm, 4.5 * mm, 0.5};
}

/// The fat of the cheek under the eye.
double malar(const Proportions& p, const Vector2d& q) {
  const Vector2d centre(0.62 * p.eye_centre.x() + 0.38 * p.zygion.x(), p.alare.y() + 3.5 * mm);
  const double r = std::hypot((q.x() - centre.x()) / (18 * mm), (q.y() - centre.y()) / (14 * mm));
  return r < 1 ? std::pow(1 - r * r, 2) : 0;
}

}  // namespace

SkinFolds::SkinFolds(const HeadTemplate& head, const Proportions& proportions)
    : head_(head), shares_(static_cast<std::size_t>(Fold::malar) + 1) {
  const std::vector<char> inner =
      simulation_mask(head, {"mouthBag", "oralRoof", "oralFloor", "upperLip", "lowerLip", "upperLipInner",
                             "lowerLipInner", "leftSocket", "rightSocket", "leftNostril", "rightNostril", "nose",
                             "leftLowerLid", "rightLowerLid", "leftUpperLid", "rightUpperLid"});
  const Crease creases[] = {nasolabial(proportions), marionette(proportions), dimple(proportions)};
  for (std::size_t i = 0; i < inner.size(); ++i) {
    const int v = head.skin_vertices[static_cast<Eigen::Index>(i)];
    const Vector3d X = head.volume.V.row(v);
    if (inner[i] || head.carrier[v] != static_cast<int>(Carrier::flesh) || X.z() < 0.4 * proportions.cheilion.z())
      continue;
    const Vector2d seen(std::abs(X.x()), X.y());
    const auto add = [&](Fold fold, double h) {
      if (std::abs(h) > 1e-3) shares_[static_cast<std::size_t>(fold)].push_back({v, h, X.x() > 0});
    };
    for (const Fold fold : {Fold::nasolabial, Fold::marionette, Fold::dimple})
      add(fold, height(creases[static_cast<std::size_t>(fold)], seen));
    add(Fold::malar, malar(proportions, seen));
  }
}

void SkinFolds::add(const ExpressionRecipe& recipe, MatrixX3d& displacement) const {
  if (recipe.folds.empty()) return;
  const MatrixX3d normals = vertex_normals(head_.volume.V + displacement, head_.skin_triangles);
  for (const FoldDepth& f : recipe.folds)
    for (const Share& s : shares_[static_cast<std::size_t>(f.fold)])
      if (s.left || !recipe.paired) displacement.row(s.vertex) += f.depth * mm * s.height * normals.row(s.vertex);
}

}  // namespace phiz
