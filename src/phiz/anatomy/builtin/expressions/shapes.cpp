// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/expressions/shapes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "phiz/anatomy/builtin/ease.h"
#include "phiz/anatomy/builtin/expressions/player.h"
#include "phiz/anatomy/builtin/expressions/recipes.h"
#include "phiz/anatomy/expression_names.h"
#include "phiz/core/error.h"

namespace phiz {
namespace {

/// The partner of every vertex under reflection in x = 0: the nearest vertex to the reflected one.
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

JawPose reflected(JawPose pose) {
  pose[1] = -pose[1];
  pose[2] = -pose[2];
  return pose;
}

/// Lets what the elasticity carries far away come to rest: below 20 micrometres nothing moves.
void still_far_regions(MatrixX3d& D) {
  for (Eigen::Index v = 0; v < D.rows(); ++v) {
    D.row(v) *= smoothstep(2e-5, 8e-5, D.row(v).norm());
  }
}

}  // namespace

std::vector<Expression> make_expressions(const HeadTemplate& head, const Proportions& proportions) {
  const ExpressionPlayer player(head, proportions);
  const VectorXi partner = mirror_partners(head.skin.V);
  std::map<std::string, Expression> made;
  MatrixX3d jaw_open;
  for (const ExpressionRecipe& recipe : expression_recipes()) {
    Expression e{std::string(recipe.name), player.play(recipe), jaw_pose(recipe, head.jaw)};
    if (!recipe.paired) e.displacement = 0.5 * (e.displacement + reflected(e.displacement, partner));
    if (e.name == "jawOpen") jaw_open = e.displacement;
    if (recipe.sealed) {  // what has to be added to the open jaw
      e.displacement -= jaw_open;
      e.jaw.setZero();
    }
    still_far_regions(e.displacement);
    if (recipe.paired) {
      Expression other{other_side(e.name), reflected(e.displacement, partner), reflected(e.jaw)};
      made.emplace(other.name, std::move(other));
    }
    made.emplace(e.name, std::move(e));
  }
  std::vector<Expression> result;
  for (const std::string_view name : expression_names) {
    const auto found = made.find(std::string(name));
    if (found == made.end()) fail("no recipe for the expression '" + std::string(name) + "'");
    result.push_back(std::move(found->second));
  }
  return result;
}

}  // namespace phiz
