// SPDX-License-Identifier: GPL-3.0-or-later
/// The reference engine of forward physics: Newton's method on the true Hessian, factorised anew in every iteration,
/// projected and shifted only where that is not positive definite; contact by an active set of planes. Slow, and right
/// to the last digits: what is fast is judged against it.
#pragma once

#include "phiz/elasticity/contact_force.h"
#include "phiz/elasticity/solve_statistics.h"
#include "phiz/elasticity/tissue_body.h"

namespace phiz {

struct NewtonStaticOptions {
  int max_iterations = 200;  ///< over all rounds
  /// Ends when the force on the free vertices, contact forces included, is this small, relative to the root of the sum
  /// over them of the squared sums of the norms of their tets' forces, at least of those that move every vertex alone
  /// by a micrometre.
  double residual_tolerance = 1e-8;
  double longest_step = 0.01;  ///< no vertex moves farther in one iteration, metres; with contact 2 mm at most

  /// Contact alternates between finding planes and solving with them fixed. It is over when planes found afresh move no
  /// vertex farther than `state_tolerance` and none is deeper than `penetration_tolerance`, metres.
  int max_rounds = 60;
  double state_tolerance = 1e-7;
  double penetration_tolerance = 1e-6;

  /// Coulomb's coefficient. Friction opposes what a vertex has slipped since `friction_reference` (n x 3; empty: since
  /// the state that the solve starts from), the state before this quasi-static increment or time step.
  double friction = 0;
  MatrixX3d friction_reference;

  Trace* trace = nullptr;  ///< gets an entry per iteration
};

/// Minimises the energy from and to x under contact; pinned vertices stay where x has them, sliding ones are put on
/// their surfaces first. `forces`, if not null, gets the contacts that push. On failure (statistics.converged = false)
/// x is the best state reached, never NaN. Throws phiz::Error(bad_input) for positions or options that make no sense.
SolveStatistics solve_static(const TissueEnergy& energy, MatrixX3d& x, const NewtonStaticOptions& options = {},
                             ContactScene* contacts = nullptr, std::vector<ContactForce>* forces = nullptr);

}  // namespace phiz
