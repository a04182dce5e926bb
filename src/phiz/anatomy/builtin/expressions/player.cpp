// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/expressions/player.h"

#include <algorithm>
#include <set>

#include "phiz/anatomy/builtin/expressions/puff.h"
#include "phiz/anatomy/builtin/expressions/seal.h"
#include "phiz/anatomy/builtin/expressions/teeth.h"
#include "phiz/geometry/operators.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/topology.h"

namespace phiz {
namespace {

constexpr int iterations = 30;
constexpr int smoothing_passes = 4;
constexpr double lip_gap = 0.00025;  ///< metres; half of what they leave at rest, so that left and right can be added

/// Evens out displacements D (one row per vertex of V) where `calm` (0 to 1 per row) allows: tets are irregular, skin
/// is not. Cotangent weights, so that the pattern of the triangles leaves no trace.
void smooth(MatrixX3d& D, const MatrixX3d& V, const MatrixX3i& triangles, const VectorXd& calm) {
  const SparseMatrixd L = cotangent_laplacian(V, triangles);
  const VectorXd diagonal = L.diagonal();
  for (int pass = 0; pass < smoothing_passes; ++pass) {
    const MatrixX3d difference = L * D;
    for (Eigen::Index v = 0; v < D.rows(); ++v)
      if (diagonal[v] > 0) D.row(v) -= 0.6 * calm[v] / diagonal[v] * difference.row(v);
  }
}

/// Cosine between every triangle and the mean normal of its corners: negative where it is folded over.
VectorXd uprightness(const MatrixX3d& V, const MatrixX3i& F) {
  const MatrixX3d faces = triangle_area_normals(V, F), normals = vertex_normals(V, F);
  VectorXd cosine(F.rows());
  for (Eigen::Index f = 0; f < F.rows(); ++f) {
    const Vector3d around = (normals.row(F(f, 0)) + normals.row(F(f, 1)) + normals.row(F(f, 2))).transpose();
    cosine[f] = faces.row(f).dot(around.transpose()) / std::max(faces.row(f).norm() * around.norm(), 1e-30);
  }
  return cosine;
}

/// Smooths the displacement round triangles that it folds over, or nearly so when they are not at rest, until there are
/// none or 40 rounds are over; farther and farther round those that resist. Vertices with `kept` stay as they are.
void mend_folds(const TriangleMesh& skin, const std::vector<std::vector<int>>& neighbours,
                const std::vector<char>& kept, MatrixX3d& D) {
  const VectorXd at_rest = uprightness(skin.V, skin.F);
  const auto add = [&kept](std::set<int>& set, int v) {
    if (!kept[static_cast<std::size_t>(v)]) set.insert(v);
  };
  for (int round = 0; round < 40; ++round) {
    const VectorXd now = uprightness(skin.V + D, skin.F);
    std::set<int> touched;
    for (Eigen::Index f = 0; f < skin.F.rows(); ++f) {
      if (now[f] >= (at_rest[f] > 0.4 ? 0.15 : 0.0)) continue;
      for (int k = 0; k < 3; ++k) add(touched, skin.F(f, k));
    }
    if (touched.empty()) return;
    for (int ring = 0; ring <= round / 10; ++ring) {
      const std::set<int> inner = touched;
      for (const int v : inner)
        for (const int w : neighbours[static_cast<std::size_t>(v)]) add(touched, w);
    }
    const MatrixX3d before = D;
    for (const int v : touched) {
      const auto& ring = neighbours[static_cast<std::size_t>(v)];
      const MatrixX3d others = before(ring, Eigen::all);
      D.row(v) = 0.5 * before.row(v) + 0.5 * others.colwise().mean();
    }
  }
}

}  // namespace

ExpressionPlayer::ExpressionPlayer(const HeadTemplate& head, const Proportions& proportions)
    : head_(head),
      proportions_(proportions),
      poser_(head.volume, head.carrier, head.skin_vertices),
      pulls_(head),
      lips_(head),
      left_lids_(head, {head.left_eye_centre, proportions.eye_radius}, "left"),
      right_lids_(head, {head.right_eye_centre, proportions.eye_radius}, "right"),
      lip_contact_(head, "upperLip", "lowerLip", lip_gap),
      neighbours_(vertex_neighbours(head.skin.F, static_cast<int>(head.skin.V.rows()))) {}

MatrixX3d ExpressionPlayer::posed(const ExpressionRecipe& recipe, const JawPose& pose, const MatrixX3d& guess,
                                  int steps) const {
  const Eigen::Isometry3d jaw = jaw_transform(head_.jaw, pose);
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
  return poser_.pose(handles, obstacles, jaw, steps, guess);
}

MatrixX3d ExpressionPlayer::play(const ExpressionRecipe& recipe) const {
  const JawPose pose = jaw_pose(recipe, head_.jaw);
  MatrixX3d X;
  if (recipe.sealed)  // the lips stretch step by step, or they would fold
    for (const double share : {0.25, 0.5, 0.75}) X = posed(recipe, share * pose, X, iterations / 2);
  X = posed(recipe, pose, X, iterations);
  MatrixX3d D = X - head_.volume.V;
  VectorXd calm(D.rows());
  for (Eigen::Index v = 0; v < D.rows(); ++v)
    calm[v] = head_.carrier[v] == static_cast<int>(Carrier::flesh)
                  ? (1 - lips_.nearness()[v]) * (1 - left_lids_.nearness()[v]) * (1 - right_lids_.nearness()[v])
                  : 0;
  smooth(D, head_.volume.V, head_.skin_triangles, calm);
  MatrixX3d drawn = head_.skin_interpolation * D(head_.skin_vertices, Eigen::all);
  if (recipe.closed) seal_lips(head_, drawn);
  lip_contact_.keep_apart(drawn);
  std::vector<char> kept(static_cast<std::size_t>(drawn.rows()), 0);  // pressed lids look folded, and are right
  left_lids_.mark_settled(head_.skin.V, kept);
  right_lids_.mark_settled(head_.skin.V, kept);
  const LidMotion other = recipe.paired ? LidMotion{} : recipe.lids;
  for (int round = 0; round < 2; ++round) {  // each may undo a little of the other
    left_lids_.settle(head_.skin.V, drawn, recipe.lids);
    right_lids_.settle(head_.skin.V, drawn, other);
    mend_folds(head_.skin, neighbours_, kept, drawn);
  }
  return drawn;
}

}  // namespace phiz
