// SPDX-License-Identifier: GPL-3.0-or-later
/// A face moved by its muscles (Ichim et al. 2017, sections 4 and 6): static states or backward Euler steps of a head's
/// tissue under activations, jaw, contact, wind and rigid objects, by the real-time engine.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "phiz/elasticity/tissue_solver.h"
#include "phiz/elasticity/wind.h"
#include "phiz/face/activation.h"

namespace phiz {

struct MuscleOptions {
  TissueOptions tissue;  ///< its gravity must be zero: see below
  bool contact = true;
  ContactOptions contact_options;
  Vector3d gravity = Vector3d::Zero();  ///< world, m/s^2. The shape of the template is at rest without it
  bool dynamic = false;
  double time_step = 1.0 / 60;  ///< of dynamics, seconds; step() divides its dt into such steps
  double damping = 0;           ///< 1/s: how fast motion relative to the head dies out by itself
  Air air;                      ///< wind (world), density and drag
  double object_step = 2e-3;    ///< objects that the head sees move farther come in parts, metres: none is jumped over
  TissueSolverOptions solve;
};

class MuscleSimulation {
 public:
  /// Orders, analyses and keeps a copy of what it needs of the model. `shapes`: one per expression of the model, as
  /// estimate_activations() makes them. Throws phiz::Error(bad_input) for models and options that cannot be simulated.
  MuscleSimulation(const FaceModel& model, const std::vector<ActivationShape>& shapes,
                   const MuscleOptions& options = {});
  ~MuscleSimulation();
  MuscleSimulation(MuscleSimulation&&) noexcept;
  MuscleSimulation& operator=(MuscleSimulation&&) noexcept;

  /// Equilibrium for expression weights (one per shape), starting from the present state; head at rest.
  SolveStatistics solve_static(const VectorXd& weights);
  /// The same for activations (a stretch per tet of tissue().body) and a pose of the jaw.
  SolveStatistics solve_static(const std::vector<Matrix3d>& stretches, const JawPose& jaw);
  /// Equilibrium at rest in the world with a pose of the head, under gravity, wind and objects: a frame of statics for
  /// a head that is somewhere, and where dynamics starts.
  SolveStatistics settle(const VectorXd& weights, const Eigen::Isometry3d& head);
  /// One frame of dynamics: `dt` seconds, at whose end the weights and the head pose (world from head) hold.
  SolveStatistics step(double dt, const VectorXd& weights, const Eigen::Isometry3d& head);
  /// Puts the state at rest in the world, in the present positions, with that pose of the head.
  void rest(const Eigen::Isometry3d& head);

  /// A closed rigid surface with outward triangles that flesh must stay outside of, at a place (world from object).
  /// Vertices that are inside of it now are not held. Returns its number.
  int add_object(const TriangleMesh& mesh, const Eigen::Isometry3d& place);
  /// Where an object is at the end of the next solve or step.
  void move_object(int object, const Eigen::Isometry3d& place);

  /// How well each muscle of the head is innervated, 0 to 1 (phace.md, demo A6); empty: all are.
  void set_innervation(const VectorXd& gain_per_muscle);
  /// The same per tet of tissue().body, see paralysis().
  void set_tet_innervation(const VectorXd& gain_per_tet);
  void set_wind(const Vector3d& wind);
  /// External force per vertex of the volume, newtons, head frame; an empty matrix for none.
  void set_forces(const MatrixX3d& forces);

  /// Vertices of the volume in the head frame, metres; the drawn skin; world velocities (dynamics).
  const MatrixX3d& positions() const;
  MatrixX3d skin() const;
  const MatrixX3d& velocity() const;
  JawPose jaw() const;
  const HeadTissue& tissue() const;
  const TissueSolver& solver() const;
  TissueSolverOptions& solve_options();
  /// Deepest penetration of the present state by an independent search, metres.
  double penetration() const;
  /// Contact forces on the vertices of the volume, newtons, head frame.
  MatrixX3d contact_forces() const;
  /// Back to the rest state, as if nothing had been solved.
  void forget();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace phiz
