// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "phiz/core/error.h"
#include "phiz/elasticity/tissue_engine.h"

namespace phiz {

namespace {

/// Solves between the state that a factor is made at in the background and its first use.
constexpr int factor_delay = 4;

}  // namespace

void TissueEngine::forget_curvature() {
  memory.clear();
  compliance.clear();
}

void TissueEngine::factorise_now(const double* at, const double* gradient) {
  const StiffnessState state = system.stiffness_state(at, gradient);
  ++counts.factorisations;
  for (const double least_curvature : {any_curvature, -0.3, 0.0}) {
    system.assemble(state, least_curvature, true, room, A);
    const int negative = factor.factorise(A);
    if (negative == 0) break;
    if (negative < 0 && least_curvature == 0)
      fail("the stiffness of the tissue is not finite", "check moduli, activations and positions");
    ++counts.projections;
  }
  has_factor = fresh = true;
  served = 0;
  factor_inverse_time_step2 = state.inverse_time_step2;
  forget_curvature();
}

void TissueEngine::start_job() {
  auto work = [this, state = system.stiffness_state(x.get(), g.get())] {
    system.assemble(state, any_curvature, false, spare_room, spare_A);
    return spare.factorise(spare_A, false) == 0;
  };
  job_due = counts.solves + factor_delay;
  ++counts.factorisations;
  factor_inverse_time_step2 = system.inverse_time_step2;
  if (options.background)
    job.start(std::move(work));
  else
    job_result = work();
}

void TissueEngine::take_job() {
  if (job_due < 0 || counts.solves < job_due) return;
  const bool good = job.is_started() ? job.get() : *job_result;
  job_result.reset();
  job_due = -1;
  if (!good) {
    has_factor = false;  // to be made now, projected if need be
    return;
  }
  std::swap(factor, spare);
  served = 0;
  fresh = false;
  forget_curvature();
}

void TissueEngine::drop_job() {
  job.drop();
  job_result.reset();
  job_due = -1;
}

}  // namespace phiz
