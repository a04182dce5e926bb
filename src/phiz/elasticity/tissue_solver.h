// SPDX-License-Identifier: GPL-3.0-or-later
/// The real-time engine of forward physics: equilibrium or a step of backward Euler of a body of muscle and passive
/// tissue under contact (Ichim et al. 2017, eq. 6.3), from the state before. Docs: docs/forward-physics.md.
///
/// Each solve starts with the tangent predictor: the equilibrium, linearised at the last state, under the new
/// activations and places of bones. Then L-BFGS on a recent Cholesky factor L of the true Hessian, in the coordinates
/// L^T x, in which the energy is nearly half the squared distance. Contact rows are constraints with multipliers that
/// only push, by the Schur complement on the same factor. Where that fails the Hessian is factorised anew, projected if
/// need be.
#pragma once

#include <memory>
#include <vector>

#include "phiz/elasticity/contact.h"
#include "phiz/elasticity/solve_statistics.h"
#include "phiz/elasticity/tissue_body.h"

namespace phiz {

struct TissueSolverOptions {
  /// Ends when an iteration moves no vertex by more than this (vertices that are not watched: a few times more),
  /// metres; what is left to go is a fraction of it.
  double step_tolerance = 5e-5;
  double residual_tolerance = 1e-3;     ///< ... and the relative force residual is below this
  double penetration_tolerance = 5e-5;  ///< ... and no vertex is deeper than this, metres
  int max_iterations = 60;
  int history = 6;             ///< pairs of L-BFGS, up to 16; 0: none
  int refresh_iterations = 3;  ///< a solve with more iterations than this asks for a new factor ...
  int refresh_solves = 12;     ///< ... and so does a factor that served this many solves
  bool background = true;      ///< make new factors on another core while solves go on; the same results on any machine
  double longest_step = 5e-3;  ///< no vertex moves farther in one iteration, metres
  double longest_lead = 8e-3;  ///< a change that the predictor would answer with more is taken in parts, metres
  Trace* trace = nullptr;  ///< gets an entry per iteration after the predictor, when set; `round` counts new factors
};

/// Iterations and factorisations since the engine was made.
struct TissueSolverCounts {
  int solves = 0, iterations = 0, factorisations = 0, projections = 0;
};

class TissueEngine;

class TissueSolver {
 public:
  /// Orders and analyses; takes some hundred milliseconds. Throws phiz::Error(bad_input) for malformed bodies and
  /// options.
  explicit TissueSolver(const TissueBody& body, const TissueSolverOptions& options = {});
  ~TissueSolver();
  TissueSolver(TissueSolver&&) noexcept;
  TissueSolver& operator=(TissueSolver&&) noexcept;

  const TissueBody& body() const;
  TissueSolverOptions& options();

  /// What muscles strive for (eq. 6.2): of tet t, entries xx, yy, zz, xy, xz, yz of its symmetric stretch; the tets of
  /// the body, those without muscle are ignored.
  void set_activation(const std::vector<Matrix3d>& stretches);
  /// The same for some tets, six floats each.
  void set_activation(const VectorXi& tets, const Eigen::Matrix<float, Eigen::Dynamic, 6, Eigen::RowMajor>& stretches);
  /// Other places of the slides, in the order of the body's.
  void set_slides(const std::vector<Slide>& slides);
  /// External force per vertex, newtons, n x 3; empty: none.
  void set_forces(const MatrixX3d& forces);
  /// As TissueEnergy::set_inertia: an empty prediction for statics.
  void set_inertia(double time_step, const MatrixX3d& prediction);

  /// The vertices whose places matter, e.g. those of the skin; others may be `slack` times the step tolerance from
  /// where they belong. All are watched to begin with.
  void watch(const VectorXi& vertices, double slack = 4);

  /// Where the next solve starts. Forgets everything but the analysis.
  void restart(const MatrixX3d& positions);
  const MatrixX3d& positions() const;

  /// Solves from the last state, with the pinned vertices at their rows of `pins`. On failure (statistics.converged =
  /// false) the state is the best one reached, never NaN.
  SolveStatistics solve(const MatrixX3d& pins, ContactScene* contacts = nullptr);

  /// Contact forces of the last solve, newtons per vertex of the body.
  MatrixX3d contact_forces() const;
  TissueSolverCounts counts() const;

 private:
  std::unique_ptr<TissueEngine> engine_;
};

}  // namespace phiz
