// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/expressions/shapes.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "phiz/anatomy/builtin/ease.h"
#include "phiz/anatomy/builtin/expressions/mirror.h"
#include "phiz/anatomy/builtin/expressions/player.h"
#include "phiz/anatomy/builtin/expressions/recipes.h"
#include "phiz/anatomy/expression_names.h"
#include "phiz/core/error.h"

namespace phiz {
namespace {

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

std::vector<Expression> make_expressions(const HeadTemplate& head, const Proportions& proportions,
                                         const std::vector<MuscleBundle>& muscles) {
  const ExpressionPlayer player(head, proportions, muscles);
  const VectorXi& partner = player.partners();
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
