// SPDX-License-Identifier: GPL-3.0-or-later
/// Plays one expression recipe on a head: muscles, lips, lids, jaw and air act, the flesh follows.
#pragma once

#include "phiz/anatomy/builtin/expressions/contact.h"
#include "phiz/anatomy/builtin/expressions/flesh.h"
#include "phiz/anatomy/builtin/expressions/folds.h"
#include "phiz/anatomy/builtin/expressions/lids.h"
#include "phiz/anatomy/builtin/expressions/lips.h"
#include "phiz/anatomy/builtin/expressions/mend.h"
#include "phiz/anatomy/builtin/expressions/pulls.h"
#include "phiz/anatomy/builtin/expressions/recipes.h"
#include "phiz/anatomy/builtin/proportions.h"
#include "phiz/anatomy/head_template.h"

namespace phiz {

class ExpressionPlayer {
 public:
  /// Keeps references to `head` and `proportions`. Throws phiz::Error naming what the head lacks.
  ExpressionPlayer(const HeadTemplate& head, const Proportions& proportions, const std::vector<MuscleBundle>& muscles);

  /// Displacement of every vertex of head.skin, metres. A paired recipe acts on the left side.
  MatrixX3d play(const ExpressionRecipe& recipe) const;

  /// The mirror image of every vertex of head.skin.
  const VectorXi& partners() const { return partners_; }

 private:
  /// Keeps the lips apart in the left expression, and in the sum of the left and the right one.
  void keep_lips_apart(bool paired, MatrixX3d& displacement) const;

  /// Positions of head.volume with the jaw at `pose`, after `steps` from `guess` or, when that is empty, from rest.
  MatrixX3d posed(const ExpressionRecipe& recipe, const JawPose& pose, const MatrixX3d& guess, int steps) const;

  const HeadTemplate& head_;
  const Proportions& proportions_;
  FleshPoser poser_;
  MusclePulls pulls_;
  LipControl lips_;
  SkinFolds folds_;
  LidControl left_lids_, right_lids_;
  PatchContact lip_contact_;
  VectorXi partners_;
  VectorXd left_share_;  ///< of what both sides do to a vertex of head.skin: 1 on the left, 0 on the right
  SkinMender mender_;
};

}  // namespace phiz
