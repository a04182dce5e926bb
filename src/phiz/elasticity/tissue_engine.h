// SPDX-License-Identifier: GPL-3.0-or-later
/// The inside of TissueSolver: its state, and the iteration in the coordinates L^T x of a recent factor L. Not a public
/// header.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "phiz/core/background.h"
#include "phiz/elasticity/contact_compliance.h"
#include "phiz/elasticity/low_rank_inverse.h"
#include "phiz/elasticity/tissue_solver.h"
#include "phiz/elasticity/tissue_system.h"

namespace phiz {

/// The contact rows of a state.
struct Contacts {
  std::vector<ContactRow> rows;    ///< vertices replaced by solver rows, those that do not move dropped
  std::vector<FactorRow> entries;  ///< of the same rows
  VectorXd multipliers;            ///< of the rows, newtons
};

/// Step of one iteration.
struct Step {
  FloatVector hat;          ///< L^T p
  FloatVector p;            ///< three per free row
  double contact_work = 0;  ///< of the contact forces along p
};

inline Eigen::Map<const Eigen::Vector3f> vector_at(const float* v, int row) {
  return Eigen::Map<const Eigen::Vector3f>(v + 3 * static_cast<std::ptrdiff_t>(row));
}

class TissueEngine {
 public:
  TissueEngine(const TissueBody& body, const TissueSolverOptions& given);
  TissueEngine(const TissueEngine&) = delete;
  TissueEngine& operator=(const TissueEngine&) = delete;

  /// As TissueSolver::solve().
  SolveStatistics solve(const MatrixX3d& pins, ContactScene* scene);
  /// At rest, relaxed flesh is in balance but for its weight.
  void start_from(const MatrixX3d& at);
  void drop_job();
  void forget_curvature();

  TissueSolverOptions options;
  TissueSystem system;
  BlockCholesky factor, spare;
  BlockMatrix A, spare_A;
  std::vector<float> room, spare_room;
  LowRankInverse memory;
  ContactCompliance compliance;
  std::map<std::int64_t, double> pushes;  ///< multipliers of the last solve, by key
  Contacts contact;
  AlignedDoubles x, trial, moved, g, next_g;
  FloatVector hat;       ///< L^-1 of the gradient and of the contact forces, one after the other
  FloatVector last_hat;  ///< of the last gradient
  MatrixX3d positions;
  std::vector<float> solved_stretch;
  std::vector<Slide> solved_slides;
  std::vector<Slide> rest_slides;
  bool settled = true;       ///< the state is near an equilibrium, from which a predictor makes sense
  bool forces_at_x = false;  ///< the last evaluation was at x, with the loads and stretches of then
  bool has_factor = false, fresh = false;
  double factor_inverse_time_step2 = 0;
  int served = 0;
  std::vector<double> correction_shares;  ///< of the last solves that made a correction
  int uncorrected = 0;                    ///< solves since the last one that did
  std::vector<double> restricted;         ///< room for a gradient
  std::vector<float> weight2;             ///< per free row: square of 1 for watched vertices, less for others
  TissueSolverCounts counts;
  std::optional<bool> job_result;
  int job_due = -1;
  Background job;  ///< uses what is above

 private:
  std::ptrdiff_t size() const { return 3 * system.free; }
  float* pushed_hat() { return hat.get() + factor.side_stride(); }
  void remember_targets();

  // === Factors: tissue_factor.cpp

  /// A factor of the Hessian at a state: exact if that is positive definite, else bounded where tets twist or are under
  /// pressure, until few negative eigenvalues are left, which count as positive.
  void factorise_now(const double* at, const double* gradient);
  void start_job();
  void take_job();

  // === Contact: tissue_multipliers.cpp

  Contacts detect(ContactScene* scene, const double* at, double patience);
  static double deepest(const Contacts& contacts);
  /// force <- C^T lambda, three per free row.
  void contact_force(const Contacts& contacts, float* force) const;
  /// |P (g - C^T lambda)| / sqrt(scale2).
  double residual(const Contacts& contacts, const double* gradient, double scale2);
  void find_multipliers(Contacts& contacts, Step& step, int pairs, float gamma);
  /// lambda_before . C p with the exact rows, which the forces of transform() belong to.
  static double work_of(const Contacts& contacts, const VectorXd& multipliers, const float* p);
  void keep_pushes(const Contacts& contacts);

  // === The iteration: tissue_descent.cpp

  /// hat <- L^-1 of the restricted gradient, and of the contact forces if there are any.
  void transform(const double* gradient, const Contacts& contacts);
  /// The step from what transform() left in `hat`; finds the multipliers.
  void find_step(Contacts& contacts, Step& step);
  void advance(const double* from, const float* p, double alpha, double* to);
  double longest(const float* p) const;
  /// The longest step of watched vertices, or a share of that of the others.
  double longest_watched(const float* p) const;
  /// g . p
  double slope(const double* gradient, const float* p) const;
  void to_floats(const double* v, float* out) const;
  /// `lead`: how far the predictor went, if it may be good enough by itself; 0 if not.
  SolveStatistics descend(ContactScene* scene, double lead, double step_tolerance, int max_iterations);

  // === tissue_engine.cpp

  /// Moves bones to `pins` and answers with the linearised equilibrium. Returns how far flesh goes; the state is only
  /// changed if that is at most `longest_lead`.
  double predict(const MatrixX3d& pins, ContactScene* scene, double longest_lead);
};

}  // namespace phiz
