// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "phiz/core/parallel.h"
#include "phiz/elasticity/tissue_engine.h"

namespace phiz {

namespace {

/// Iterations before steps that turn back are relaxed.
constexpr int settle = 5;
/// Where more iterations than this are to be expected on an old factor, a new one is cheaper.
constexpr double cheap_iterations = 6;
constexpr int tried_iterations = 2;  ///< on the old one, before that is judged
/// A factor that had so many iterations without convergence is renewed in any case.
constexpr int patience = 8;
/// Of the first corrections after predictors, as shares of the predictors' steps, the largest of so many decides
/// whether the next one is worth making.
constexpr std::size_t remembered_shares = 6;
constexpr int most_uncorrected = 4;  ///< solves in a row
/// Relative error of the energy.
constexpr double energy_rounding = 1e-7;

}  // namespace

void TissueEngine::to_floats(const double* v, float* out) const {
  for (std::ptrdiff_t r = 0; r < system.free; ++r)
    for (int k = 0; k < 3; ++k) out[3 * r + k] = static_cast<float>(v[4 * r + k]);
}

double TissueEngine::longest(const float* p) const {
  float longest2 = 0;
  for (int r = 0; r < system.free; ++r) longest2 = std::max(longest2, vector_at(p, r).squaredNorm());
  return std::sqrt(static_cast<double>(longest2));
}

double TissueEngine::longest_watched(const float* p) const {
  float longest2 = 0;
  for (int r = 0; r < system.free; ++r)
    longest2 = std::max(longest2, weight2[static_cast<std::size_t>(r)] * vector_at(p, r).squaredNorm());
  return std::sqrt(static_cast<double>(longest2));
}

double TissueEngine::slope(const double* gradient, const float* p) const {
  return parallel_sum(system.free, 2048, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    double sum = 0;
    for (std::ptrdiff_t r = begin; r < end; ++r)
      for (int k = 0; k < 3; ++k) sum += gradient[4 * r + k] * static_cast<double>(p[3 * r + k]);
    return sum;
  });
}

void TissueEngine::transform(const double* gradient, const Contacts& contacts) {
  restricted.assign(gradient, gradient + 4 * system.free);
  system.restrict_to_slides(restricted.data());
  to_floats(restricted.data(), hat.get());
  contact_force(contacts, pushed_hat());
  const bool pushed = contacts.multipliers.size() > 0 && contacts.multipliers.maxCoeff() > 0;
  if (!pushed) std::fill_n(pushed_hat(), size(), 0.0F);
  factor.forward(hat.get(), pushed ? 2 : 1);
}

void TissueEngine::find_step(Contacts& contacts, Step& step) {
  const int pairs = memory.pairs();
  const auto gamma = static_cast<float>(memory.gamma());
  FloatVector excess = float_vector(size());  // L^-1 (g - C^T lambda)
  combine({hat.get(), pushed_hat()}, Eigen::Vector2f(1, -1), excess.get(), size());
  const Eigen::VectorXd u = memory.products(excess.get());
  memory.apply(excess.get(), memory.middle(u), -1, step.hat.get());
  step.contact_work = 0;
  if (!contacts.rows.empty()) find_multipliers(contacts, step, pairs, gamma);
  std::copy_n(step.hat.get(), size(), step.p.get());
  factor.backward(step.p.get());
  for (const SlidingRow& s : system.sliding) {
    Eigen::Map<Eigen::Vector3f> p(step.p.get() + 3 * static_cast<std::ptrdiff_t>(s.row));
    p = (s.keep.cast<float>() * p).eval();
  }
}

void TissueEngine::advance(const double* from, const float* p, double alpha, double* to) {
  parallel_chunks(system.free, 2048, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t r = begin; r < end; ++r)
      for (int k = 0; k < 3; ++k) to[4 * r + k] = from[4 * r + k] + alpha * static_cast<double>(p[3 * r + k]);
  });
  std::copy(from + 4 * system.free, from + 4 * system.rows, to + 4 * system.free);
  system.put_on_slides(to);
}

SolveStatistics TissueEngine::descend(ContactScene* scene, double lead, double step_tolerance, int max_iterations) {
  SolveStatistics statistics;
  Step step{float_vector(size()), float_vector(size())};
  FloatVector last_p = float_vector(size());
  AlignedDoubles apart = zero_doubles(4 * system.rows);
  bool has_apart = false;  // the last state without penetration
  double last_length2 = 0, relaxation = 1;
  double scale2 = 0;
  double energy = system.evaluate(x.get(), g.get(), &scale2);
  forces_at_x = true;
  bool is_judged = false;
  const auto judge = [&](double reach) {
    is_judged = true;
    statistics.residual = residual(contact, g.get(), scale2);
    statistics.penetration = deepest(contact);
    statistics.contacts = static_cast<int>((contact.multipliers.array() > 0).count());
    statistics.converged = reach <= step_tolerance && statistics.residual <= options.residual_tolerance &&
                           statistics.penetration <= options.penetration_tolerance;
  };
  const double share = correction_shares.empty()
                           ? std::numeric_limits<double>::infinity()
                           : *std::max_element(correction_shares.begin(), correction_shares.end());
  const bool may_suffice = lead > 0 && uncorrected < most_uncorrected && share * lead <= 0.5 * step_tolerance;
  contact = detect(scene, x.get(), may_suffice ? 0 : 1);
  if (may_suffice) {
    judge(share * lead);
    statistics.last_step = share * lead;
    if (statistics.converged) {
      ++uncorrected;
      statistics.energy = energy;
      return statistics;
    }
  }
  transform(g.get(), contact);
  std::copy_n(hat.get(), size(), last_hat.get());
  memory.start(hat.get());
  int on_factor = 0, renewed = 0;
  const auto start = std::chrono::steady_clock::now();
  const auto note = [&](double length, double reach) {
    if (options.trace == nullptr) return;
    TraceEntry entry;
    entry.iteration = statistics.iterations;
    entry.round = renewed;
    entry.energy = energy;
    entry.residual = residual(contact, g.get(), scale2);
    entry.contacts = static_cast<int>((contact.multipliers.array() > 0).count());
    entry.violation = deepest(contact);
    entry.step_length = length;
    entry.last_step = length * reach;
    entry.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    options.trace->push_back(entry);
  };
  const auto renew_factor = [&] {
    drop_job();
    factorise_now(x.get(), g.get());
    on_factor = 0;
    relaxation = 1;
    ++renewed;
    transform(g.get(), contact);
    std::copy_n(hat.get(), size(), last_hat.get());
    memory.start(hat.get());
  };
  double last_seen = lead;
  while (statistics.iterations < max_iterations) {
    ++statistics.iterations;
    if (on_factor++ == patience) renew_factor();
    const VectorXd before = contact.multipliers;
    find_step(contact, step);
    const double reach = longest(step.p.get());
    // How many steps are left, by how much this one is shorter than the last.
    const double seen = longest_watched(step.p.get());
    const double rate = std::clamp(seen / std::max(last_seen, 1e-12), 0.05, 0.9);
    const double expected = std::log(std::max(seen / step_tolerance, 1.0)) / -std::log(rate);
    last_seen = seen;
    if (!std::isfinite(reach) || (!fresh && expected > cheap_iterations && on_factor > tried_iterations)) {
      if (fresh) break;
      contact.multipliers = before;
      renew_factor();
      continue;
    }
    if (statistics.iterations == 1 && lead > 0) {
      uncorrected = 0;
      if (correction_shares.size() == remembered_shares) correction_shares.erase(correction_shares.begin());
      correction_shares.push_back(longest_watched(step.p.get()) / lead);
    }
    const double contact_work = step.contact_work + work_of(contact, before, step.p.get());
    const double decrease = contact_work - slope(g.get(), step.p.get());
    const Eigen::VectorXd products = dots({last_p.get(), step.p.get()}, step.p.get(), size());
    if (!contact.rows.empty() && statistics.iterations > settle &&
        products[0] < -0.3 * std::sqrt(products[1] * last_length2))
      relaxation *= 0.6;
    else
      relaxation = std::min(1.0, 1.1 * relaxation);
    std::copy_n(step.p.get(), size(), last_p.get());
    last_length2 = products[1];
    double alpha = relaxation;
    if (alpha * reach > options.longest_step) alpha = options.longest_step / reach;
    const double rounding = energy_rounding * std::abs(energy) + 1e-16;
    double next_energy = energy, next_scale2 = scale2;
    bool accepted = false;
    for (int halving = 0; halving < (fresh ? 16 : 2) && std::isfinite(reach); ++halving, alpha *= 0.5) {
      advance(x.get(), step.p.get(), alpha, trial.get());
      next_energy = system.evaluate(trial.get(), next_g.get(), &next_scale2);
      forces_at_x = false;
      if (next_energy - alpha * contact_work <= energy - 1e-4 * alpha * decrease + rounding) {
        accepted = true;
        break;
      }
    }
    if (!accepted) {
      note(0, reach);
      if (memory.pairs() > 0 || !fresh) {
        contact.multipliers = before;
        renew_factor();
        continue;
      }
      system.put_on_slides(x.get());  // the energy is as low as rounding lets it be seen
      system.evaluate(x.get(), g.get(), &scale2);
      forces_at_x = true;
      judge(seen);
      statistics.last_step = seen;
      break;
    }
    note(alpha, reach);
    is_judged = false;
    std::copy_n(trial.get(), 4 * system.rows, x.get());
    forces_at_x = true;
    std::swap(g, next_g);
    energy = next_energy;
    scale2 = next_scale2;
    fresh = false;
    keep_pushes(contact);
    statistics.last_step = seen * std::min(1.0, alpha / relaxation);
    const bool last = statistics.iterations == max_iterations;
    const bool stalled = relaxation < 0.2 && alpha * seen <= step_tolerance;
    const bool judged = statistics.last_step <= step_tolerance || last || stalled;
    contact = detect(scene, x.get(), judged ? 0 : 1 / relaxation);
    if (judged) judge(statistics.last_step);
    if (scene != nullptr && statistics.iterations > settle && deepest(contact) <= options.penetration_tolerance) {
      std::copy_n(x.get(), 4 * system.rows, apart.get());
      has_apart = true;
    }
    if (last || stalled || statistics.converged) break;
    transform(g.get(), contact);
    if (options.history > 0) {
      // The pair in the coordinates of the factor: step and change of the gradient.
      FloatVector s = float_vector(size()), y = float_vector(size());
      combine({step.hat.get()}, Eigen::VectorXf::Constant(1, static_cast<float>(alpha)), s.get(), size());
      combine({hat.get(), last_hat.get()}, Eigen::Vector2f(1, -1), y.get(), size());
      memory.add(s.get(), y.get(), y.get(), hat.get());
    }
    std::copy_n(hat.get(), size(), last_hat.get());
  }
  if (!is_judged) {
    contact = detect(scene, x.get(), 0);
    judge(statistics.last_step);
  }
  if (has_apart && statistics.penetration > options.penetration_tolerance) {
    // Two states took turns; of the two, the one without penetration.
    std::copy_n(apart.get(), 4 * system.rows, x.get());
    system.put_on_slides(x.get());
    contact = detect(scene, x.get(), 0);
    energy = system.evaluate(x.get(), g.get(), &scale2);
    forces_at_x = true;
    judge(statistics.last_step);
  }
  statistics.energy = energy;
  return statistics;
}

}  // namespace phiz
