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
       .pulls = {{"orbicularisOculi", 0.22, Part::lower, 0.5, 1},
                 {"orbicularisOculi", 0.05, Part::upper, 0.5, 1},
                 {"zygomaticusMinor", 0.05},
                 {"levatorLabiiSuperioris", 0.03}},
       .lids = {.lower = 0.10},
       .closed = true},
  };
}

std::vector<ExpressionRecipe> brow_and_nose_recipes() {
  return {
      // AU4
      {.name = "browDownLeft",
       .paired = true,
       .pulls = {{"corrugator", 0.30},
                 {"procerus", 0.34, Part::left},
                 {"orbicularisOculi", 0.24, Part::upper, 0.5, 1}}},
      // AU1: medial frontalis of both sides, with the corrugators' slant.
      {.name = "browInnerUp",
       .pulls = {{"frontalisLeft", 0.23, Part::whole, 0, 0.45},
                 {"frontalisRight", 0.23, Part::whole, 0, 0.45},
                 {"corrugatorLeft", 0.06},
                 {"corrugatorRight", 0.06}}},
      // AU2
      {.name = "browOuterUpLeft", .paired = true, .pulls = {{"frontalis", 0.20, Part::whole, 0.55, 1}}},
      // AU9
      {.name = "noseSneerLeft",
       .paired = true,
       .pulls = {{"levatorLabiiSuperiorisAlaequeNasi", 0.24},
                 {"nasalis", 0.10},
                 {"levatorLabiiSuperioris", 0.08},
                 {"procerus", 0.22, Part::left},
                 {"corrugator", 0.05}},
       .upper_lip = {{.up = 1.4}, {.up = 2.4}, {.up = 1.2}, 0.6},
       .lids = {.lower = 0.06}},
  };
}

std::vector<ExpressionRecipe> jaw_recipes() {
  return {
      {.name = "jawForward", .jaw_down = 0.6, .jaw_forward = 7},
      {.name = "jawLeft", .paired = true, .swing = 0.085, .jaw_down = 0.3, .jaw_side = 3.5},
      // AU27
      {.name = "jawOpen",
       .upper_lip = {{.up = 1.5}, {.up = 1}, {}, 0.3},
       .lower_lip = {{.up = -1}, {.up = -1}, {}, 0.3},
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
       .pulls = {{"orbicularisOris", 0.12}},
       .upper_lip = {{.up = 4, .out = 10, .roll = 26},
                     {.up = 2.8, .out = 8.8, .wide = -5.2, .roll = 24},
                     {.out = 6.5, .wide = -10.5, .roll = 8},
                     2.5},
       .lower_lip = {{.up = -5, .out = 9.5, .roll = 26},
                     {.up = -3.8, .out = 8.8, .wide = -5.2, .roll = 24},
                     {.out = 6.5, .wide = -10.5, .roll = 8},
                     2.5}},
      // AU18
      {.name = "mouthPucker",
       .pulls = {{"orbicularisOris", 0.2}},
       .upper_lip = {{.up = -1.7, .out = 9.5, .roll = 14, .thin = -0.3},
                     {.up = -1.4, .out = 9, .wide = -6, .roll = 14, .thin = -0.3},
                     {.out = 6, .wide = -11.5},
                     3},
       .lower_lip = {{.up = 1.7, .out = 9.5, .roll = 14, .thin = -0.2},
                     {.up = 1.4, .out = 9, .wide = -6, .roll = 14, .thin = -0.2},
                     {.out = 6, .wide = -11.5},
                     3},
       .closed = true},
      // AU28, one lip at a time; the other drapes over it.
      {.name = "mouthRollLower",
       .pulls = {{"mentalisLeft", 0.04}, {"mentalisRight", 0.04}},
       .upper_lip = {{.up = -0.8, .out = 0.4}, {.up = -0.5, .out = 0.3}, {}, 1.5},
       .lower_lip = {{.up = -1.5, .out = -3.4, .roll = -30, .thin = 0.55},
                     {.up = -1.2, .out = -3, .roll = -26, .thin = 0.5},
                     {},
                     6}},
      {.name = "mouthRollUpper",
       .upper_lip = {{.up = 1.5, .out = -3.4, .roll = -30, .thin = 0.55},
                     {.up = 1.2, .out = -3, .roll = -26, .thin = 0.5},
                     {},
                     6},
       .lower_lip = {{.up = 0.6, .out = 0.3}, {.up = 0.5, .out = 0.3}, {}, 1.5}},
      // AU17
      {.name = "mouthShrugLower",
       .pulls = {{"mentalisLeft", 0.30}, {"mentalisRight", 0.30}},
       .upper_lip = {{.up = 3.7, .out = 1.2}, {.up = 2.5, .out = 0.8}, {.up = -0.5}, 2},
       .lower_lip = {{.up = 4, .out = 2.5, .roll = 8}, {.up = 2.7, .out = 1.8, .roll = 6}, {.up = -0.5}, 2},
       .closed = true},
      {.name = "mouthShrugUpper",
       .pulls = {{"levatorLabiiSuperiorisAlaequeNasiLeft", 0.03}, {"levatorLabiiSuperiorisAlaequeNasiRight", 0.03}},
       .upper_lip = {{.up = 3.2, .out = 3, .roll = 14}, {.up = 2.4, .out = 2.3, .roll = 10}, {}, 2.5},
       .lower_lip = {{.up = 1.2, .out = 0.6}, {.up = 0.9, .out = 0.4}, {}, 1}},
      // AU24, one side: both lips turn in against each other.
      {.name = "mouthPressLeft",
       .paired = true,
       .pulls = {{"buccinator", 0.03}},
       .upper_lip = {{.up = 1.2, .out = -1.6, .roll = -14, .thin = 0.3},
                     {.up = 0.7, .out = -1.6, .roll = -18, .thin = 0.35},
                     {.out = -1},
                     4},
       .lower_lip = {{.up = -1.2, .out = -1.6, .roll = -14, .thin = 0.3},
                     {.up = -0.7, .out = -1.6, .roll = -18, .thin = 0.35},
                     {.out = -1},
                     4},
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
       .pulls = {{"zygomaticusMajor", 0.34},
                 {"zygomaticusMinor", 0.18},
                 {"levatorAnguliOris", 0.20},
                 {"orbicularisOculi", 0.08, Part::lower, 0.5, 1}},
       .upper_lip =
           {{.up = 0.8, .out = -0.6}, {.up = 2.6, .out = -1.8, .wide = 2.5}, {.up = 8, .out = -6, .wide = 7}, 0.6},
       .lower_lip =
           {{.up = 0.3, .out = -0.5}, {.up = 2.2, .out = -1.6, .wide = 2.5}, {.up = 8, .out = -6, .wide = 7}, 0.6},
       .lids = {.lower = 0.06},
       .closed = true},
      // AU15
      {.name = "mouthFrownLeft",
       .paired = true,
       .pulls = {{"depressorAnguliOris", 0.16}, {"platysma", 0.02}, {"mentalis", 0.06}},
       .upper_lip = {{.up = -0.2}, {.up = -1.6, .wide = 0.8}, {.up = -7, .out = -2, .wide = 2.5}, 0.8},
       .lower_lip = {{.up = 0.2}, {.up = -1.5, .wide = 0.8}, {.up = -7, .out = -2, .wide = 2.5}, 0.8},
       .closed = true},
      // AU14: the corner is drawn back into the cheek.
      {.name = "mouthDimpleLeft",
       .paired = true,
       .pulls = {{"buccinator", 0.30}, {"risorius", 0.12}},
       .upper_lip = {{}, {.out = -0.4, .wide = 1.4}, {.up = 0.6, .out = -4, .wide = 4}, 0.5},
       .lower_lip = {{}, {.out = -0.4, .wide = 1.4}, {.up = 0.6, .out = -4, .wide = 4}, 0.5},
       .closed = true},
      // AU20
      {.name = "mouthStretchLeft",
       .paired = true,
       .pulls = {{"risorius", 0.45}, {"platysma", 0.08, Part::whole, 0.4, 1}, {"depressorAnguliOris", 0.05}},
       .upper_lip = {{}, {.up = -0.3, .out = -0.8, .wide = 2.6}, {.up = -1.2, .out = -4, .wide = 7.5}, 0.8},
       .lower_lip = {{}, {.up = -1.0, .out = -0.8, .wide = 2.6}, {.up = -1.2, .out = -4, .wide = 7.5}, 0.8},
       .closed = true},
      // AU16
      {.name = "mouthLowerDownLeft",
       .paired = true,
       .pulls = {{"depressorLabiiInferioris", 0.24}, {"platysma", 0.02}},
       .lower_lip = {{.up = -3.5, .out = 0.3}, {.up = -5, .out = 0.2, .wide = 0.8}, {.up = -2.4, .wide = 1}, 1.2}},
      // AU10
      {.name = "mouthUpperUpLeft",
       .paired = true,
       .pulls = {{"levatorLabiiSuperioris", 0.11}, {"zygomaticusMinor", 0.08}},
       .upper_lip = {{.up = 3.5, .out = 0.3}, {.up = 5, .out = 0.2, .wide = 0.6}, {.up = 2.8, .wide = 0.6}, 1.6}},
      // The whole mouth drawn aside: the muscles of one cheek pull, the ring of the lips follows.
      {.name = "mouthLeft",
       .paired = true,
       .both_halves = true,
       .pulls = {{"zygomaticusMajor", 0.08}, {"risorius", 0.30}, {"buccinator", 0.22}},
       .upper_lip = {{.out = 0.4, .left = 7.5}, {.out = 0.2, .left = 7}, {.left = 6}, 1.2},
       .lower_lip = {{.out = 0.4, .left = 7}, {.out = 0.2, .left = 6.5}, {.left = 6}, 1.2},
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
