// SPDX-License-Identifier: GPL-3.0-or-later
/// Shortening muscles: tissue at arc length s of a fibre moves along the fibre towards the origin by its
/// share of the shortening; a ring draws together.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "phiz/anatomy/builtin/expressions/flesh.h"
#include "phiz/anatomy/builtin/expressions/recipes.h"
#include "phiz/anatomy/builtin/muscles.h"
#include "phiz/anatomy/head_template.h"

namespace phiz {

class MusclePulls {
 public:
  /// Flesh vertices of `head` within 12 mm of a fibre of `muscles` go with it.
  MusclePulls(const HeadTemplate& head, const std::vector<MuscleBundle>& muscles);

  /// What the muscles of a recipe draw. In a paired recipe names without a side mean the left muscle.
  /// Throws phiz::Error(bad_input) naming a muscle that the head does not have.
  std::vector<Pull> pulls(const ExpressionRecipe& recipe) const;

 private:
  /// A vertex in the reach of a muscle: the nearest fibre and the place on it.
  struct Reach {
    int vertex;
    int fibre;
    double along;   ///< arc length from the origin / length
    double weight;  ///< 1 at the fibre, 0 at the end of the reach
  };
  struct Bundle {
    std::vector<MatrixX3d> fibres;
    std::vector<Reach> reach;
    Vector3d centre;
    bool ring;
  };
  Pull pull(const Bundle& bundle, const Reach& reach, double shortening) const;

  MatrixX3d rest_;
  std::map<std::string, Bundle> bundles_;
};

}  // namespace phiz
