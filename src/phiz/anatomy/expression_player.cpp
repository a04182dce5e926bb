// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/expression_player.h"

#include "phiz/anatomy/expression_puff.h"
#include "phiz/anatomy/expression_teeth.h"

namespace phiz {
namespace {

constexpr int iterations = 30;

}  // namespace

ExpressionPlayer::ExpressionPlayer(const HeadTemplate& head, const Proportions& proportions)
    : head_(head),
      proportions_(proportions),
      poser_(head.volume, head.carrier, head.skin_vertices),
      pulls_(head),
      lips_(head),
      left_lids_(head, {head.left_eye_centre, proportions.eye_radius}, "left"),
      right_lids_(head, {head.right_eye_centre, proportions.eye_radius}, "right") {}

MatrixX3d ExpressionPlayer::play(const ExpressionRecipe& recipe) const {
  const Eigen::Isometry3d jaw = jaw_transform(head_.jaw, jaw_pose(recipe, head_.jaw));
  std::vector<Handle> handles = pulls_.handles(recipe);
  const auto add = [&handles](const std::vector<Handle>& more) {
    handles.insert(handles.end(), more.begin(), more.end());
  };
  const LidMotion other = recipe.paired ? LidMotion{} : recipe.lids;
  add(lips_.handles(recipe, jaw));
  add(left_lids_.handles(recipe.lids));
  add(right_lids_.handles(other));
  if (recipe.puff != 0) add(puff_handles(head_, proportions_, recipe.puff * 1e-3));
  const std::vector<Obstacle> obstacles = {dental_arches(head_, proportions_.arch, jaw),
                                           left_lids_.eyeball(recipe.lids), right_lids_.eyeball(other)};
  const MatrixX3d X = poser_.pose(handles, obstacles, jaw, iterations);
  const MatrixX3d moved = (X - head_.volume.V)(head_.skin_vertices, Eigen::all);
  return head_.skin_interpolation * moved;
}

}  // namespace phiz
