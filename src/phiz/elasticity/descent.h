// SPDX-License-Identifier: GPL-3.0-or-later
/// The iteration of ProjectiveDynamics: sequential quadratic steps in the metric of the factor (corrected by
/// quasi-Newton pairs) under the linearised contact rows. Not a public header.
#pragma once

#include <cstdint>
#include <vector>

#include "phiz/elasticity/elastic_system.h"

namespace phiz {

/// The contact rows of one iteration in solver rows, with the columns that meet the quasi-Newton pairs.
struct ContactRows {
  std::vector<ContactRow> rows;      ///< vertices replaced by solver rows, fixed ones dropped
  std::vector<std::int64_t> vertex;  ///< identifies pair and vertex
  std::vector<std::int64_t> key;     ///< and whether it is the row of the closest face, for warm starts
};

/// One accelerated solve.
class Descent {
 public:
  Descent(ElasticSystem& system, const SolveOptions& options, ContactScene* contacts);

  /// From and to x (four doubles per vertex).
  SolveStatistics run(double* x);

 private:
  ContactRows detect(const double* x, double patience = 1);
  /// Step p from the gradient and its image under A^-1; fills lambda_ and row_motion_.
  void find_step(const ContactRows& contact, const float* gradient, const float* inverse_gradient, float* p);
  /// Fills lambda_ for the rows `working`. U: their products with the quasi-Newton pairs.
  void find_multipliers(const ContactRows& contact, const std::vector<Eigen::Index>& working, const Eigen::MatrixXd& U);
  bool was_active(std::int64_t key) const;
  /// force_ <- gradient - C^T lambda.
  void subtract_contact_forces(const ContactRows& contact, const float* gradient);
  /// Relative norm of the forces at the state that was evaluated last, whose gradient is given.
  double residual(const ContactRows& contact, const float* gradient);

  ElasticSystem& system_;
  const SolveOptions& options_;
  ContactScene* contacts_;
  LowRankInverse& inverse_;
  Eigen::VectorXd lambda_;      ///< multiplier per row of the last find_step, newtons
  Eigen::VectorXd row_motion_;  ///< C p of the last find_step, metres
  std::vector<std::int64_t> active_keys_;
  FloatVector force_;  ///< room for a vector of forces
};

}  // namespace phiz
