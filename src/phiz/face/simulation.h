// SPDX-License-Identifier: GPL-3.0-or-later
/// Simulation: a face model in motion. Static states or backward Euler steps that follow blended target gradients, with
/// a rigid jaw and contact of lips, cheeks, teeth and lids (Ichim 2017, section 5.3.4).
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <vector>

#include "phiz/elasticity/projective_dynamics.h"
#include "phiz/face/face_model.h"

namespace phiz {

/// Defaults for animation; what they trade is argued in docs/volumetric-blendshapes.md.
struct SimulationOptions {
  SimulationOptions() {
    solve.max_iterations = 24;
    solve.step_tolerance = 1.5e-5;
    solve.residual_tolerance = 1e9;  // the step decides; the residual is reported
    solve.history = 6;
  }
  bool contact = true;
  bool dynamic = false;
  TermWeights weights{1.0, 1.0, 10.0};  ///< target, shape (elasticity about the target's stretch), volume
  double stiffness = 3000;              ///< shear scale E0, pascals
  double density = 1000;                ///< kg/m^3
  double time_step = 1.0 / 60;          ///< of dynamics, seconds; step() divides its dt into such steps
  Vector3d gravity = Vector3d::Zero();  ///< world, m/s^2; dynamics only
  double longest_lead = 4e-3;           ///< a static change that moves flesh farther is taken in parts, metres
  ContactOptions contact_options;
  SolveOptions solve;
};

/// What a later run needs to continue as if it had not been interrupted.
struct SimulationState {
  MatrixX3d positions;  ///< of all vertices of the volume, head frame, metres
  MatrixX3d velocity;   ///< world, m/s; empty in statics
  VectorXd weights;     ///< expression weights of that state
  Eigen::Isometry3d head = Eigen::Isometry3d::Identity();
};

class Simulation {
 public:
  /// Factorises; takes a second or two. Throws phiz::Error for models that cannot be simulated.
  explicit Simulation(const FaceModel& model, const SimulationOptions& options = {});
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  /// Static state for expression weights (one per FaceModel::shapes), starting from the present state.
  SolveStatistics solve_static(const VectorXd& weights);
  /// One frame of dynamics: `dt` seconds, at whose end the weights and the head pose (world from head) hold.
  SolveStatistics step(double dt, const VectorXd& weights, const Eigen::Isometry3d& head);

  /// Vertices of the volume in the head frame, metres.
  const MatrixX3d& positions() const;
  /// The drawn skin in the head frame, metres.
  MatrixX3d skin() const;
  JawPose jaw() const;
  /// External force per vertex of the volume, newtons, head frame; an empty matrix for none.
  void set_forces(const MatrixX3d& forces);

  /// States depend on those before them, within the tolerances of the solve, unless forget() comes between: restore()
  /// forgets too.
  void forget();
  SimulationState state() const;
  void restore(const SimulationState& state);

  const VectorXi& soft_tets() const;
  const SimulationOptions& options() const;
  /// Expected and actual contact of the present state, by an independent search, metres.
  double penetration() const;
  /// Vertices that are not checked against an obstacle because they are inside of it at rest.
  int contacts_left_out() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace phiz
