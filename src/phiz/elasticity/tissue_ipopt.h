// SPDX-License-Identifier: GPL-3.0-or-later
/// Forward physics by IPOPT (Waechter and Biegler 2006), the solver that the Phace papers used: an independent check of
/// our engines and their rival in speed. The same energy, exact Hessian and contact planes as in tissue_newton.h,
/// handed to an interior-point method; contact alternates with detection in the same way. A target of its own
/// (phiz::ipopt_reference): IPOPT's licence lets nobody pass on a binary that holds it together with GPL code.
#pragma once

#include <string>

#include "phiz/elasticity/contact_force.h"
#include "phiz/elasticity/solve_statistics.h"
#include "phiz/elasticity/tissue_body.h"

namespace phiz {

struct IpoptStaticOptions {
  int max_iterations = 500;  ///< over all rounds
  /// As in NewtonStaticOptions; IPOPT's own tolerance follows from it.
  double residual_tolerance = 1e-8;
  int max_rounds = 60;
  double state_tolerance = 1e-7;        ///< metres
  double penetration_tolerance = 1e-6;  ///< metres
  std::string linear_solver = "mumps";  ///< the one that Debian's build holds
  /// Order of elimination in MUMPS: 0 AMD, 3 SCOTCH, 4 PORD, 6 QAMD, 7 automatic.
  int mumps_pivot_order = 7;
  /// Weight of the barrier that the second round starts with; every later one starts with a hundredth of the one
  /// before.
  double warm_barrier = 1e-6;
  /// Gets an entry per iteration; the residual in it is IPOPT's own, of about our scale, contacts are not counted.
  Trace* trace = nullptr;
};

/// Minimises the energy from and to x under contact without friction, like solve_static(). Sliding on a plane is
/// eliminated from the unknowns, sliding on a curved surface is an equality constraint.
SolveStatistics solve_static_with_ipopt(const TissueEnergy& energy, MatrixX3d& x,
                                        const IpoptStaticOptions& options = {}, ContactScene* contacts = nullptr,
                                        std::vector<ContactForce>* forces = nullptr);

}  // namespace phiz
