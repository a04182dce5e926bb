// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/face/static_problem.h"

#include "phiz/anatomy/jaw.h"
#include "phiz/geometry/operators.h"

namespace phiz {

StaticProblem::StaticProblem(const FaceModel& model, const std::vector<ActivationShape>& shapes,
                             const MuscleOptions& options)
    : model_(model),
      shapes_(shapes),
      options_(options),
      tissue_(head_tissue(model.head, options.tissue)),
      blender_(shapes, tissue_),
      energy_(tissue_.body),
      drawn_skin_(model.head) {
  if (!options.gravity.isZero(0))
    energy_.set_forces(lumped_tet_mass(tissue_.body.rest, tissue_.body.tets, options.tissue.density) *
                       options.gravity.transpose());
}

SolveStatistics StaticProblem::solve(const VectorXd& weights, MatrixX3d& x, const Solve& engine) {
  const JawPose jaw = blend_jaw(model_.head.jaw, shapes_, weights);
  energy_.set_activation(blender_.blend(weights));
  place_jaw(model_.head, tissue_, jaw, energy_, x);
  if (!options_.contact) return engine(energy_, x, nullptr);
  HeadContacts contacts(model_.head, options_.contact_options);
  contacts.place_jaw(jaw_transform(model_.head.jaw, jaw));
  return engine(energy_, x, &contacts.scene);
}

double StaticProblem::skin_distance(const MatrixX3d& x, const MatrixX3d& y) const {
  return (drawn_skin_.at(x) - drawn_skin_.at(y)).rowwise().norm().maxCoeff();
}

}  // namespace phiz
