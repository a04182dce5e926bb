// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/tissue_step.h"

#include <cmath>

#include "phiz/core/error.h"

namespace phiz {

namespace {

/// Switches inertia off again, also when a solve throws.
class Inertia {
 public:
  explicit Inertia(TissueEnergy& energy) : energy_(energy) {}
  ~Inertia() { energy_.set_inertia(1, {}); }
  Inertia(const Inertia&) = delete;
  Inertia& operator=(const Inertia&) = delete;

 private:
  TissueEnergy& energy_;
};

void require_sense(Eigen::Index n, const TissueState& state, const TissueStepOptions& options, const MatrixX3d& pins) {
  if (state.x.rows() != n || state.v.rows() != n || !state.x.allFinite() || !state.v.allFinite())
    reject("time step", "needs a finite position and velocity for every vertex");
  if (!(options.time_step > 0 && std::isfinite(options.time_step)) || options.substeps < 1 ||
      !(options.damping >= 0 && std::isfinite(options.damping)))
    reject("time step", "needs a positive length, one substep or more and damping that is not negative");
  if (pins.rows() != 0 && pins.rows() != n) reject("time step", "needs a place for every pinned vertex");
}

}  // namespace

SolveStatistics step(TissueEnergy& energy, TissueState& state, const TissueStepOptions& options, const MatrixX3d& pins,
                     ContactScene* contacts, std::vector<ContactForce>* forces) {
  const TissueBody& body = energy.body();
  require_sense(body.rest.rows(), state, options, pins);
  const double h = options.time_step / options.substeps;
  const double slower = 1 + options.damping * h;
  const MatrixX3d first = state.x;
  const MatrixX3d& last = pins.rows() > 0 ? pins : first;
  const Inertia inertia(energy);
  SolveStatistics all;
  all.converged = true;
  for (int part = 1; part <= options.substeps; ++part) {
    const MatrixX3d before = state.x;
    // m (v' - v) / h + c m v' is the gradient of (1 + c h) m |x' - x - h v / (1 + c h)|^2 / (2 h^2).
    const MatrixX3d prediction = before + h / slower * state.v;
    energy.set_inertia(h / std::sqrt(slower), prediction);
    // What may be in contact has to be followed on its way.
    if (contacts == nullptr) state.x = prediction;
    const double share = static_cast<double>(part) / options.substeps;
    for (Eigen::Index v = 0; v < before.rows(); ++v) {
      if (body.pinned[static_cast<std::size_t>(v)] != 0)
        state.x.row(v) = first.row(v) + share * (last.row(v) - first.row(v));
    }
    NewtonStaticOptions solve = options.solve;
    solve.friction_reference = before;
    const SolveStatistics one = solve_static(energy, state.x, solve, contacts, forces);
    state.v = (state.x - before) / h;
    const SolveStatistics sofar = all;
    all = one;
    all.converged = one.converged && sofar.converged;
    all.iterations += sofar.iterations;
    all.milliseconds += sofar.milliseconds;
  }
  return all;
}

}  // namespace phiz
