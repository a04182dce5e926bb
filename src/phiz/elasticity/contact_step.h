// SPDX-License-Identifier: GPL-3.0-or-later
/// One step of Newton's method under contact planes: the reference engine's quadratic subproblem. Not a public header.
#pragma once

#include <optional>

#include "phiz/elasticity/contact_planes.h"
#include "phiz/numerics/cholesky.h"

namespace phiz {

/// Where a solver is: positions, how they may move, what pushes.
struct ContactState {
  MatrixX3d x;
  FreeMotion motion;
  VectorXd gradient;                       ///< of the energy, in the unknowns
  Eigen::Matrix3Xd separation;             ///< of every contact
  Eigen::SparseMatrix<double> derivative;  ///< of the separation, transposed
};

/// Minimises g p + p H p / 2 with gap + C p >= 0 and Coulomb's law for the slip. H is the true Hessian where that is
/// positive definite, else a projected one, shifted as little as makes it so. Contacts that touch and push count as
/// bilateral in H (augmented Lagrangian): that changes no step that keeps them, and makes H definite where only
/// contacts hold the body.
class ContactStep {
 public:
  explicit ContactStep(const TissueEnergy& energy) : energy_(energy) {}

  /// Returns p. `forces` (3 x m: pressure and friction of every contact, in its frame, newtons) are those before and
  /// after the step.
  VectorXd operator()(const ContactState& state, double friction, Eigen::Matrix3Xd& forces);

  /// Whether the last step used the true Hessian, which was positive definite then; true before the first one.
  bool is_exact() const { return is_exact_; }

 private:
  bool factorise(const SparseMatrixd& H);
  VectorXd solve(const ContactState& state, const VectorXd& gradient, double friction, Eigen::Matrix3Xd& forces) const;

  const TissueEnergy& energy_;
  std::optional<SparseCholesky> factor_;
  SparseMatrixd factorised_;  ///< for its pattern
  bool is_exact_ = true;
};

}  // namespace phiz
