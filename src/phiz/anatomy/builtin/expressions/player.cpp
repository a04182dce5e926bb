// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/expressions/player.h"

#include <algorithm>

#include "phiz/anatomy/builtin/ease.h"
#include "phiz/anatomy/builtin/expressions/mirror.h"
#include "phiz/anatomy/builtin/expressions/puff.h"
#include "phiz/anatomy/builtin/expressions/seal.h"
#include "phiz/anatomy/builtin/expressions/teeth.h"
#include "phiz/geometry/operators.h"
#include "phiz/numerics/cholesky.h"

namespace phiz {
namespace {

constexpr int iterations = 30;
constexpr double smoothing_length = 0.003;  ///< metres
constexpr double lip_gap = 0.00018;  ///< metres; half of what they leave at rest, so that left and right can be added

/// Evens out displacements D (one row per vertex of V) over `smoothing_length` where `calm` (0 to 1 per row) allows:
/// tets are irregular, skin is not. One implicit step of diffusion, so that the density of the triangles leaves no
/// trace; little spreads from where calm is low.
void smooth(MatrixX3d& D, const MatrixX3d& V, const MatrixX3i& triangles, const VectorXd& calm) {
  VectorXd mass = lumped_triangle_mass(V, triangles);
  for (double& m : mass)
    if (m <= 0) m = 1;  // what is not skin stays as it is
  VectorXd conduction(triangles.rows());
  for (Eigen::Index f = 0; f < triangles.rows(); ++f)
    conduction[f] = std::pow(smoothing_length * calm(triangles.row(f)).minCoeff(), 2);
  SparseMatrixd M(V.rows(), V.rows());
  M.setIdentity();
  M.diagonal() = mass;
  const SparseMatrixd A = M + cotangent_laplacian(V, triangles, conduction);
  D = SparseCholesky(A).solve(M * D);
}

}  // namespace

ExpressionPlayer::ExpressionPlayer(const HeadTemplate& head, const Proportions& proportions,
                                   const std::vector<MuscleBundle>& muscles)
    : head_(head),
      proportions_(proportions),
      poser_(head.volume, head.carrier, head.skin_vertices),
      pulls_(head, muscles),
      lips_(head),
      folds_(head, proportions),
      left_lids_(head, {head.left_eye_centre, proportions.eye_radius}, "left"),
      right_lids_(head, {head.right_eye_centre, proportions.eye_radius}, "right"),
      lip_contact_(head, "upperLip", "lowerLip", lip_gap),
      partners_(mirror_partners(head.skin.V)),
      left_share_(head.skin.V.col(0).unaryExpr([](double x) { return smoothstep(-0.01, 0.01, x); })),
      mender_(head) {}

MatrixX3d ExpressionPlayer::posed(const ExpressionRecipe& recipe, const JawPose& pose, const MatrixX3d& guess,
                                  int steps) const {
  const Eigen::Isometry3d jaw = jaw_transform(head_.jaw, pose);
  std::vector<Handle> handles;
  const auto add = [&handles](const std::vector<Handle>& more) {
    handles.insert(handles.end(), more.begin(), more.end());
  };
  const LidMotion other = recipe.paired ? LidMotion{} : recipe.lids;
  add(lips_.handles(recipe, jaw));
  if (!pose.isZero()) add(floor_handles(head_, jaw));
  add(left_lids_.handles(recipe.lids));
  add(right_lids_.handles(other));
  if (recipe.puff != 0) add(puff_handles(head_, proportions_, recipe.puff * 1e-3));
  const std::vector<Obstacle> obstacles = {dental_arches(head_, proportions_.arch, jaw),
                                           left_lids_.eyeball(recipe.lids), right_lids_.eyeball(other)};
  return poser_.pose(handles, pulls_.pulls(recipe), obstacles, jaw, steps, guess);
}

void ExpressionPlayer::keep_lips_apart(bool paired, MatrixX3d& displacement) const {
  lip_contact_.keep_apart(displacement);
  if (!paired) return;
  const MatrixX3d both = displacement + reflected(displacement, partners_);
  MatrixX3d apart = both;
  lip_contact_.keep_apart(apart);
  displacement += left_share_.asDiagonal() * (apart - both);
}

MatrixX3d ExpressionPlayer::play(const ExpressionRecipe& recipe) const {
  const JawPose pose = jaw_pose(recipe, head_.jaw);
  MatrixX3d X;
  if (recipe.sealed)  // the lips stretch step by step, or they would fold
    for (const double share : {0.25, 0.5, 0.75}) X = posed(recipe, share * pose, X, iterations / 2);
  X = posed(recipe, pose, X, recipe.open > 0.3 ? 2 * iterations : iterations);  // a long way for what is under the jaw
  MatrixX3d D = X - head_.volume.V;
  VectorXd calm(D.rows());
  for (Eigen::Index v = 0; v < D.rows(); ++v)
    calm[v] = head_.carrier[v] == static_cast<int>(Carrier::flesh)
                  ? (1 - lips_.nearness()[v]) * (1 - left_lids_.nearness()[v]) * (1 - right_lids_.nearness()[v])
                  : 0;
  smooth(D, head_.volume.V, head_.skin_triangles, calm);
  folds_.add(recipe, D);
  MatrixX3d drawn = head_.skin_interpolation * D(head_.skin_vertices, Eigen::all);
  std::vector<char> kept(static_cast<std::size_t>(drawn.rows()), 0);  // what is pressed together looks folded
  left_lids_.mark_settled(head_.skin.V, kept);
  right_lids_.mark_settled(head_.skin.V, kept);
  if (recipe.closed)
    seal_lips(head_, drawn);
  else if (recipe.open < 0.1 && std::max(recipe.upper_lip.hold, recipe.lower_lip.hold) > 0)
    join_corners(head_, drawn);
  keep_lips_apart(recipe.paired, drawn);
  const LidMotion other = recipe.paired ? LidMotion{} : recipe.lids;
  for (int round = 0; round < 2; ++round) {  // each may undo a little of the other
    left_lids_.settle(head_.skin.V, drawn, recipe.lids);
    right_lids_.settle(head_.skin.V, drawn, other);
    mender_.mend_folds(kept, drawn);
  }
  mender_.mend_crossings_in_the_mouth(drawn);
  return drawn;
}

}  // namespace phiz
