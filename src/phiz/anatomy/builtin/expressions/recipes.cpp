// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/expressions/recipes.h"

namespace phiz {
namespace {

using Part = MusclePull::Part;

std::vector<ExpressionRecipe> eye_recipes() {
  return {
      // AU45: the upper lid does most of the way.
      {.name = "eyeBlinkLeft",
       .paired = true,
       .pulls = {{"orbicularisOculi", 0.03, Part::lower, 0.2, 1}},
       .lids = {.upper = 0.88, .lower = 0.12}},
      // The lids follow the gaze.
      {.name = "eyeLookDownLeft", .paired = true, .lids = {.upper = 0.38, .lower = -0.18, .bulge_up = -30}},
      {.name = "eyeLookUpLeft",
       .paired = true,
       .pulls = {{"frontalis", 0.02}},
       .lids = {.upper = -0.30, .lower = 0.06, .bulge_up = 28}},
      {.name = "eyeLookInLeft", .paired = true, .lids = {.sideways = -3.5, .bulge_side = -32}},
      {.name = "eyeLookOutLeft", .paired = true, .lids = {.sideways = 3.5, .bulge_side = 32}},
      // AU7: the lower lid rises and straightens.
      {.name = "eyeSquintLeft",
       .paired = true,
       .pulls = {{"orbicularisOculi", 0.10, Part::lower, 0, 0.8}, {"orbicularisOculi", 0.04, Part::upper, 0, 1}},
       .lids = {.upper = 0.06, .lower = 0.24}},
      // AU5
      {.name = "eyeWideLeft", .paired = true, .pulls = {{"frontalis", 0.02}}, .lids = {.upper = -0.31, .lower = -0.09}},
      // AU6: the outer ring gathers the cheek under the eye.
      {.name = "cheekSquintLeft",
       .paired = true,
       .pulls = {{"orbicularisOculi", 0.18, Part::lower, 0.4, 1},
                 {"orbicularisOculi", 0.06, Part::upper, 0.5, 1},
                 {"zygomaticusMinor", 0.13},
                 {"zygomaticusMajor", 0.06},
                 {"levatorLabiiSuperioris", 0.06}},
       .lids = {.lower = 0.10},
       .folds = {{Fold::malar, 3.2}, {Fold::nasolabial, 0.7}},
       .closed = true},
  };
}

std::vector<ExpressionRecipe> brow_and_nose_recipes() {
  return {
      // AU4
      {.name = "browDownLeft",
       .paired = true,
       .pulls = {{"corrugator", 0.26},
                 {"procerus", 0.22, Part::left},
                 {"orbicularisOculi", 0.20, Part::upper, 0.5, 1}}},
      // AU1: medial frontalis of both sides, with the corrugators' slant.
      {.name = "browInnerUp",
       .pulls = {{"frontalisLeft", 0.13, Part::whole, 0, 0.5},
                 {"frontalisRight", 0.13, Part::whole, 0, 0.5},
                 {"corrugatorLeft", 0.04},
                 {"corrugatorRight", 0.04}}},
      // AU2
      {.name = "browOuterUpLeft", .paired = true, .pulls = {{"frontalis", 0.15, Part::whole, 0.55, 1}}},
      // AU9
      {.name = "noseSneerLeft",
       .paired = true,
       .pulls = {{"levatorLabiiSuperiorisAlaequeNasi", 0.30},
                 {"levatorLabiiSuperioris", 0.14},
                 {"procerus", 0.08, Part::left},
                 {"corrugator", 0.05}},
       .upper_lip = {{.up = 2.4}, {.up = 4.6, .wide = 0.6}, {.up = 2.4}, 0.8},
       .lids = {.lower = 0.06},
       .folds = {{Fold::nasolabial, 1.1}, {Fold::malar, 0.8}}},
  };
}

std::vector<ExpressionRecipe> jaw_recipes() {
  return {
      {.name = "jawForward", .jaw_down = 2.2, .jaw_forward = 10, .closed = true},
      {.name = "jawLeft", .paired = true, .swing = 0.085, .jaw_down = 1.0, .jaw_side = 3.5, .closed = true},
      // AU27
      {.name = "jawOpen",
       .upper_lip = {{.up = 1.2, .out = -0.6, .thin = 0.15},
                     {.up = 1, .out = -0.8, .wide = -1.4, .thin = 0.2},
                     {.up = 1.5, .out = -0.5, .wide = -3},
                     1},
       .lower_lip = {{.up = -0.6, .out = -0.6, .thin = 0.15},
                     {.up = -0.6, .out = -0.8, .wide = -1.4, .thin = 0.2},
                     {.up = 1.5, .out = -0.5, .wide = -3},
                     1},
       .open = 0.44,
       .jaw_down = 1.0,
       .jaw_forward = 4},
      // The lips stay closed while the jaw opens; made as the difference to jawOpen.
      {.name = "mouthClose", .open = 0.44, .jaw_down = 1.0, .jaw_forward = 4, .sealed = true},
      {.name = "tongueOut",
       .lower_lip = {.centre = {.up = -2, .out = 1.5, .roll = 8}, .middle = {.up = -1.5, .out = 1}, .hold = 1},
       .open = 0.16,
       .jaw_down = 0.5,
       .jaw_forward = 1.5},
  };
}

std::vector<ExpressionRecipe> lip_ring_recipes() {
  return {
      // AU22: open, round, turned outward.
      {.name = "mouthFunnel",
       .pulls = {{"orbicularisOris", 0.10}},
       .upper_lip = {{.up = 4.6, .out = 9.8, .roll = 30},
                     {.up = 4.2, .out = 8.4, .wide = -4.4, .roll = 28},
                     {.out = 6.5, .wide = -8.6, .roll = 8},
                     3},
       .lower_lip = {{.up = -5.4, .out = 9, .roll = 30},
                     {.up = -4.8, .out = 8.2, .wide = -4.4, .roll = 28},
                     {.out = 6.5, .wide = -8.6, .roll = 8},
                     3},
       .jaw_down = 1.5},
      // AU18
      {.name = "mouthPucker",
       .pulls = {{"orbicularisOris", 0.18}},
       .upper_lip = {{.up = -0.9, .out = 9.5, .roll = 20, .thin = -0.35},
                     {.up = -1.4, .out = 9, .wide = -5.6, .roll = 18, .thin = -0.4},
                     {.out = 7, .wide = -10.6},
                     3},
       .lower_lip = {{.up = 1.2, .out = 9.5, .roll = 20, .thin = -0.25},
                     {.up = 1.2, .out = 9, .wide = -5.6, .roll = 18, .thin = -0.3},
                     {.out = 7, .wide = -10.6},
                     3},
       .closed = true},
      // AU28, one lip at a time; the other drapes over it.
      {.name = "mouthRollLower",
       .pulls = {{"mentalisLeft", 0.06}, {"mentalisRight", 0.06}},
       .upper_lip = {{.up = -0.8, .out = 0.2}, {.up = -0.5, .out = 0.2}, {}, 1.5},
       .lower_lip = {{.up = -0.6, .out = -4.6, .roll = -38, .thin = 0.55},
                     {.up = -0.5, .out = -4, .roll = -32, .thin = 0.5},
                     {},
                     6}},
      {.name = "mouthRollUpper",
       .upper_lip = {{.up = 0.8, .out = -4.4, .roll = -38, .thin = 0.55},
                     {.up = 0.6, .out = -3.8, .roll = -32, .thin = 0.5},
                     {},
                     6},
       .lower_lip = {{.up = 0.6, .out = 0.2}, {.up = 0.5, .out = 0.2}, {}, 1.5}},
      // AU17
      {.name = "mouthShrugLower",
       .pulls = {{"mentalisLeft", 0.5}, {"mentalisRight", 0.5}},
       .upper_lip = {{.up = 4.4, .out = 2}, {.up = 3.2, .out = 1.4}, {.up = -1}, 2},
       .lower_lip = {{.up = 5, .out = 4.2, .roll = 14}, {.up = 3.6, .out = 3.2, .roll = 10}, {.up = -1}, 2},
       .closed = true},
      {.name = "mouthShrugUpper",
       .pulls = {{"levatorLabiiSuperiorisAlaequeNasiLeft", 0.05}, {"levatorLabiiSuperiorisAlaequeNasiRight", 0.05}},
       .upper_lip = {{.up = 4, .out = 3.4, .roll = 16}, {.up = 3, .out = 2.6, .roll = 12}, {}, 2.5},
       .lower_lip = {{.up = 1.2, .out = 0.6}, {.up = 0.9, .out = 0.4}, {}, 1}},
      // AU24, one side: both lips turn in against each other.
      {.name = "mouthPressLeft",
       .paired = true,
       .pulls = {{"buccinator", 0.08}, {"mentalis", 0.14}},
       .upper_lip = {{.up = 0.8, .out = -2, .roll = -20, .thin = 0.4},
                     {.up = 0.5, .out = -2, .roll = -22, .thin = 0.42},
                     {.up = 0.4, .out = -2.6, .wide = 1.6},
                     4},
       .lower_lip = {{.up = -0.8, .out = -2, .roll = -20, .thin = 0.4},
                     {.up = -0.5, .out = -2, .roll = -22, .thin = 0.42},
                     {.up = 0.4, .out = -2.6, .wide = 1.6},
                     4},
       .folds = {{Fold::dimple, 0.7}},
       .closed = true},
      {.name = "cheekPuff",
       .upper_lip = {{.out = 1.2}, {.out = 1.2}, {.out = 0.5}, 1},
       .lower_lip = {{.out = 1.2}, {.out = 1.2}, {.out = 0.5}, 1},
       .puff = 11.5,
       .closed = true},
  };
}

std::vector<ExpressionRecipe> mouth_pull_recipes() {
  return {
      // AU12: the ring of the lips follows the corner.
      {.name = "mouthSmileLeft",
       .paired = true,
       .pulls = {{"zygomaticusMajor", 0.36},
                 {"zygomaticusMinor", 0.22},
                 {"levatorAnguliOris", 0.24},
                 {"orbicularisOculi", 0.08, Part::lower, 0.5, 1}},
       .upper_lip = {{.up = 1.4, .out = -1.4, .thin = 0.12},
                     {.up = 4.2, .out = -3.2, .wide = 4.4, .thin = 0.16},
                     {.up = 10.5, .out = -8.5, .wide = 8.5},
                     0.9},
       .lower_lip = {{.up = 1.2, .out = -1, .thin = 0.1},
                     {.up = 3.8, .out = -3, .wide = 4.4, .thin = 0.12},
                     {.up = 10.5, .out = -8.5, .wide = 8.5},
                     0.9},
       .lids = {.lower = 0.06},
       .folds = {{Fold::nasolabial, 1.8}, {Fold::malar, 2.2}},
       .closed = true},
      // AU15
      {.name = "mouthFrownLeft",
       .paired = true,
       .pulls = {{"depressorAnguliOris", 0.20}, {"platysma", 0.03}, {"mentalis", 0.12}},
       .upper_lip = {{.up = -0.2}, {.up = -1.8, .wide = 1}, {.up = -7.5, .out = -2.2, .wide = 2.5}, 0.8},
       .lower_lip = {{.up = 0.6, .out = 0.4}, {.up = -1.2, .wide = 1}, {.up = -7.5, .out = -2.2, .wide = 2.5}, 0.8},
       .folds = {{Fold::marionette, 1.3}},
       .closed = true},
      // AU14: the corner is drawn back into the cheek.
      {.name = "mouthDimpleLeft",
       .paired = true,
       .pulls = {{"buccinator", 0.34}, {"risorius", 0.16}},
       .upper_lip =
           {{.out = -0.4}, {.up = 0.4, .out = -1.4, .wide = 2, .thin = 0.1}, {.up = 1.8, .out = -7, .wide = 3.6}, 0.8},
       .lower_lip =
           {{.out = -0.4}, {.up = 0.4, .out = -1.4, .wide = 2, .thin = 0.1}, {.up = 1.8, .out = -7, .wide = 3.6}, 0.8},
       .folds = {{Fold::dimple, 1.1}},
       .closed = true},
      // AU20
      {.name = "mouthStretchLeft",
       .paired = true,
       .pulls = {{"risorius", 0.5}, {"platysma", 0.10, Part::whole, 0.4, 1}, {"depressorAnguliOris", 0.08}},
       .upper_lip = {{.out = -0.8, .thin = 0.1},
                     {.up = -0.8, .out = -2.4, .wide = 4.2, .thin = 0.12},
                     {.up = -3, .out = -6.5, .wide = 8.5},
                     1},
       .lower_lip = {{.out = -0.8, .thin = 0.1},
                     {.up = -1.4, .out = -2.4, .wide = 4.2, .thin = 0.12},
                     {.up = -3, .out = -6.5, .wide = 8.5},
                     1},
       .folds = {{Fold::dimple, 0.8}},
       .closed = true},
      // AU16
      {.name = "mouthLowerDownLeft",
       .paired = true,
       .pulls = {{"depressorLabiiInferioris", 0.30}, {"platysma", 0.03}},
       .lower_lip = {{.up = -5, .out = 0.6, .roll = 6},
                     {.up = -6.8, .out = 0.4, .wide = 1.2, .roll = 6},
                     {.up = -2.6, .wide = 1.2},
                     1.4}},
      // AU10
      {.name = "mouthUpperUpLeft",
       .paired = true,
       .pulls = {{"levatorLabiiSuperioris", 0.20},
                 {"zygomaticusMinor", 0.12},
                 {"levatorLabiiSuperiorisAlaequeNasi", 0.08}},
       .upper_lip =
           {{.up = 5.5, .out = 0.3}, {.up = 7.6, .out = -0.4, .wide = 1.2}, {.up = 3.4, .out = -0.6, .wide = 0.8}, 1.6},
       .folds = {{Fold::nasolabial, 0.9}, {Fold::malar, 0.8}}},
      // The whole mouth drawn aside: the muscles of one cheek pull, the ring of the lips follows.
      {.name = "mouthLeft",
       .paired = true,
       .both_halves = true,
       .pulls = {{"zygomaticusMajor", 0.12}, {"risorius", 0.40}, {"buccinator", 0.30}},
       .upper_lip = {{.up = 0.4, .out = -0.5, .left = 12.5},
                     {.up = 0.6, .wide = -1.6, .left = 12.2, .turn = 2.4},
                     {.up = 1.4, .out = 0.6, .wide = -3.6, .left = 10.6, .turn = 5.2},
                     1.6},
       .lower_lip = {{.up = 0.4, .out = -0.5, .left = 12.2},
                     {.up = 0.6, .wide = -1.6, .left = 12, .turn = 2.4},
                     {.up = 1.4, .out = 0.6, .wide = -3.6, .left = 10.6, .turn = 5.2},
                     1.6},
       .folds = {{Fold::nasolabial, 1.0}, {Fold::dimple, 0.8}},
       .closed = true},
  };
}

}  // namespace

std::span<const ExpressionRecipe> expression_recipes() {
  static const std::vector<ExpressionRecipe> recipes = [] {
    std::vector<ExpressionRecipe> all;
    for (const auto& group :
         {eye_recipes(), brow_and_nose_recipes(), jaw_recipes(), lip_ring_recipes(), mouth_pull_recipes()})
      all.insert(all.end(), group.begin(), group.end());
    return all;
  }();
  return recipes;
}

JawPose jaw_pose(const ExpressionRecipe& recipe, const JawJoint& joint) {
  JawPose pose;
  pose << recipe.open, recipe.swing, recipe.jaw_side * 1e-3, -recipe.jaw_down * 1e-3, recipe.jaw_forward * 1e-3;
  return pose.cwiseMax(joint.lower).cwiseMin(joint.upper);
}

std::string other_side(std::string_view name) {
  constexpr std::string_view left = "Left", right = "Right";
  if (name.ends_with(left)) return std::string(name.substr(0, name.size() - left.size())) + "Right";
  if (name.ends_with(right)) return std::string(name.substr(0, name.size() - right.size())) + "Left";
  return std::string(name);
}

}  // namespace phiz
