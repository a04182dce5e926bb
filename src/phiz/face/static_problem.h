// SPDX-License-Identifier: GPL-3.0-or-later
/// The static problem of a face moved by its muscles, as engines other than the real-time one take it.
#pragma once

#include <functional>
#include <vector>

#include "phiz/face/drawn_skin.h"
#include "phiz/face/head_contacts.h"
#include "phiz/face/muscle_simulation.h"

namespace phiz {

class StaticProblem {
 public:
  /// The problem that a static MuscleSimulation with the same arguments solves, without objects, wind and forces.
  StaticProblem(const FaceModel& model, const std::vector<ActivationShape>& shapes, const MuscleOptions& options);

  using Solve = std::function<SolveStatistics(const TissueEnergy& energy, MatrixX3d& x, ContactScene* contacts)>;
  /// Solves for weights (one per shape) from and to x; bones are put in place first. Contact knows of no state before.
  SolveStatistics solve(const VectorXd& weights, MatrixX3d& x, const Solve& engine);

  /// Largest distance of drawn skin vertices in two states, metres.
  double skin_distance(const MatrixX3d& x, const MatrixX3d& y) const;

 private:
  const FaceModel& model_;
  std::vector<ActivationShape> shapes_;
  MuscleOptions options_;
  HeadTissue tissue_;
  ActivationBlender blender_;
  TissueEnergy energy_;
  DrawnSkin drawn_skin_;
};

}  // namespace phiz
