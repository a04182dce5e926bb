// SPDX-License-Identifier: GPL-3.0-or-later
/// How each expression is made: which muscles shorten, what the ring of the lips and the lids do, how the jaw stands.
/// After the facial action coding system (Ekman and Friesen 1978); the action unit is noted in the table.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "phiz/anatomy/jaw.h"

namespace phiz {

/// A muscle that shortens by a share of its length. In a paired recipe names without Left/Right mean the left one.
struct MusclePull {
  enum class Part { whole, upper, lower, left };  ///< the half of a ring, or the left half of a midline muscle
  std::string_view muscle;
  double shortening = 0;  ///< 0.2: its insertion moves by a fifth of its length along it
  Part part = Part::whole;
  double from = 0, to = 1;  ///< range across the fibres: 0 medial or inner, 1 lateral or outer
};

/// What a cross-section of a lip does, at one place along the lip.
struct LipSection {
  double up = 0;    ///< mm
  double out = 0;   ///< mm, away from the teeth
  double wide = 0;  ///< mm, away from the midline; none at the centre
  double left = 0;  ///< mm, towards the person's left
  double turn = 0;  ///< mm, the left side back and the right side forward; none at the centre
  double roll = 0;  ///< degrees about the lip's length: positive turns the red outward, negative tucks it in
  double thin = 0;  ///< share by which the height of the red shrinks towards the parting line; negative: fuller
};

/// A lip at its centre, halfway to the corner, and at the corner.
struct LipMotion {
  LipSection centre{}, middle{}, corner{};
  double hold = 0;  ///< stiffness of the control: 0 leaves the lip to the flesh, 1 guides, 6 decides
};

/// Lid margins: the share of the way to closing that each travels (negative opens), and the turn with the gaze.
struct LidMotion {
  double upper = 0, lower = 0;
  double sideways = 0;                  ///< degrees about the vertical axis of the eye, positive away from the nose
  double bulge_up = 0, bulge_side = 0;  ///< gaze (degrees) whose cornea pushes the lids out
};

/// Where skin dips or stands out as flesh is gathered.
enum class Fold {
  nasolabial,  ///< from the wing of the nose round the corner of the mouth
  marionette,  ///< from the corner of the mouth down
  dimple,      ///< beside the corner of the mouth
  malar,       ///< no crease: the fat of the cheek under the eye
};
struct FoldDepth {
  Fold fold;
  double depth = 0;  ///< mm
};

struct ExpressionRecipe {
  std::string_view name;     ///< the left one of a pair
  bool paired = false;       ///< also made for the right side, by reflection
  bool both_halves = false;  ///< a paired recipe that moves the lips of both halves all the same
  std::vector<MusclePull> pulls{};
  LipMotion upper_lip{}, lower_lip{};
  LidMotion lids{};  ///< of the left eye
  std::vector<FoldDepth> folds{};
  double open = 0, swing = 0;                          ///< jaw, radians
  double jaw_down = 0, jaw_forward = 0, jaw_side = 0;  ///< jaw, mm
  double puff = 0;                                     ///< mm by which air in the mouth pushes the cheeks out
  bool closed = false;                                 ///< lips that stay closed
  bool sealed = false;                                 ///< keeps the lips closed whatever the jaw does
};

/// The 32 recipes from which the 52 expressions of expression_names are made.
std::span<const ExpressionRecipe> expression_recipes();

/// The jaw pose of a recipe, held within the joint's limits.
JawPose jaw_pose(const ExpressionRecipe& recipe, const JawJoint& joint);

/// "eyeBlinkRight" for "eyeBlinkLeft", "mouthRight" for "mouthLeft".
std::string other_side(std::string_view name);

}  // namespace phiz
