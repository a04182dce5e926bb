// SPDX-License-Identifier: GPL-3.0-or-later
/// Dynamics of the reference engine: backward Euler as a minimisation (phace.md section 7.1).
#pragma once

#include "phiz/elasticity/tissue_newton.h"

namespace phiz {

/// Positions (metres) and velocities (metres/second) of all vertices, n x 3.
struct TissueState {
  MatrixX3d x, v;
};

struct TissueStepOptions {
  double time_step = 1.0 / 30;  ///< seconds
  int substeps = 1;             ///< the step is made in that many equal parts
  double damping = 0;           ///< 1/second: a force -damping * mass * velocity on every vertex
  NewtonStaticOptions solve;    ///< friction refers to the start of a substep, whatever `friction_reference` says
};

/// Moves the state on by one step: v' = (x' - x) / h with mass ((v' - v) / h + damping v') = all forces at x'. `pins`
/// (n x 3, only the rows of pinned vertices matter): where pinned vertices arrive, on a straight line; empty: they
/// stay. The energy's inertia is used and left switched off. The statistics add up the substeps; where one did not
/// converge they say so, and the state is the best that was found. Throws phiz::Error(bad_input) when sizes or options
/// make no sense.
SolveStatistics step(TissueEnergy& energy, TissueState& state, const TissueStepOptions& options = {},
                     const MatrixX3d& pins = {}, ContactScene* contacts = nullptr,
                     std::vector<ContactForce>* forces = nullptr);

}  // namespace phiz
