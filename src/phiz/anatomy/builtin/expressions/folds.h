// SPDX-License-Identifier: GPL-3.0-or-later
/// Creases and pads: along some lines the skin is tethered to what lies below and dips when the flesh beside it is
/// gathered; in some places fat is gathered and stands out.
#pragma once

#include <vector>

#include "phiz/anatomy/builtin/expressions/recipes.h"
#include "phiz/anatomy/builtin/proportions.h"
#include "phiz/anatomy/head_template.h"

namespace phiz {

class SkinFolds {
 public:
  /// Takes the outer skin of the simulation skin of `head`, built from `proportions`.
  SkinFolds(const HeadTemplate& head, const Proportions& proportions);

  /// Adds the folds of a recipe to the displacement of head.volume (metres), along the moved skin's normals. A paired
  /// recipe acts on the left side.
  void add(const ExpressionRecipe& recipe, MatrixX3d& displacement) const;

 private:
  /// A vertex and how far it stands out per metre of depth, on the left or right side.
  struct Share {
    int vertex;
    double height;
    bool left;
  };
  const HeadTemplate& head_;
  std::vector<std::vector<Share>> shares_;  ///< per Fold
};

}  // namespace phiz
