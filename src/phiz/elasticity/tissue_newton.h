// SPDX-License-Identifier: GPL-3.0-or-later
/// The reference engine of forward physics: Newton's method on the true Hessian, factorised anew in every iteration,
/// projected and shifted only where that is not positive definite. Slow, and right to the last digits: what is fast is
/// judged against it.
#pragma once

#include "phiz/elasticity/solve_statistics.h"
#include "phiz/elasticity/tissue_body.h"

namespace phiz {

struct NewtonStaticOptions {
  int max_iterations = 200;
  /// Ends when the force on the free vertices is this small, relative to the root of the sum over them of the squared
  /// sums of the norms of their tets' forces.
  double residual_tolerance = 1e-8;
  double longest_step = 0.01;  ///< no vertex moves farther in one iteration, metres
};

/// Minimises the energy from and to x; pinned vertices stay where x has them, sliding ones are put on their surfaces
/// first. On failure (statistics.converged = false) x is the best state reached, never NaN.
SolveStatistics solve_static(const TissueEnergy& energy, MatrixX3d& x, const NewtonStaticOptions& options = {});

}  // namespace phiz
