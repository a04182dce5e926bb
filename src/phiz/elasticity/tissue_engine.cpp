// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/tissue_engine.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "phiz/core/error.h"

namespace phiz {

namespace {

/// How far bones move, metres, in the difference that tells what their motion does to the forces.
constexpr double probe = 1e-4;
constexpr double least_motion = 1e-9;  ///< of bones, metres

const TissueSolverOptions& checked(const TissueSolverOptions& o) {
  if (!(o.step_tolerance > 0) || !(o.residual_tolerance > 0) || !(o.penetration_tolerance > 0) ||
      o.max_iterations < 1 || o.history < 0 || o.refresh_iterations < 1 || o.refresh_solves < 1 ||
      !(o.longest_step > 0) || !(o.longest_lead > 0))
    reject("tissue solver options", "tolerances, steps and counts must be positive");
  return o;
}

}  // namespace

TissueEngine::TissueEngine(const TissueBody& body, const TissueSolverOptions& given)
    : options(checked(given)),
      system(body),
      factor(system.pattern, FactorStorage::rounded),
      spare(factor.twin()),
      A(system.pattern),
      spare_A(system.pattern),
      memory(size(), std::clamp(given.history, 1, LowRankInverse::most_history)),
      x(zero_doubles(4 * system.rows)),
      trial(zero_doubles(4 * system.rows)),
      moved(zero_doubles(4 * system.rows)),
      g(zero_doubles(4 * system.free)),
      next_g(zero_doubles(4 * system.free)),
      hat(float_vector(2 * factor.side_stride())),
      last_hat(float_vector(size())),
      positions(body.rest),
      weight2(static_cast<std::size_t>(system.free), 1.0F) {
  rest_slides = body.slides;
  start_from(body.rest);
}

void TissueEngine::start_from(const MatrixX3d& at) {
  positions = at;
  forces_at_x = false;
  system.load(at, x.get());
  system.put_on_slides(x.get());
  settled = at == system.body.rest;
  remember_targets();
  if (!settled) return;
  solved_slides = rest_slides;
  for (std::size_t i = 0; i < solved_stretch.size(); ++i) {
    const std::size_t entry = i / static_cast<std::size_t>(TissueBlocks::width) % 6;
    solved_stretch[i] = entry < 3 ? 1 : 0;
  }
}

void TissueEngine::remember_targets() {
  solved_stretch.assign(system.blocks.stretch.get(),
                        system.blocks.stretch.get() + 6 * TissueBlocks::width * system.blocks.muscle_blocks);
  solved_slides = system.body.slides;
}

double TissueEngine::predict(const MatrixX3d& pins, ContactScene* scene, double longest_lead) {
  std::copy_n(x.get(), 4 * system.rows, moved.get());
  for (std::ptrdiff_t r = system.free; r < system.rows; ++r)
    Eigen::Map<Vector3d>(moved.get() + 4 * r) = pins.row(system.vertex_of[r]).transpose();
  const std::vector<SlidingRow> sliding_before = system.sliding;
  system.put_on_slides(moved.get());
  std::vector<char> moves(static_cast<std::size_t>(system.rows), 0);
  double farthest = 0;
  for (std::ptrdiff_t r = 0; r < system.rows; ++r) {
    const double way =
        (Eigen::Map<const Vector3d>(moved.get() + 4 * r) - Eigen::Map<const Vector3d>(x.get() + 4 * r)).norm();
    moves[static_cast<std::size_t>(r)] = way > least_motion;
    farthest = std::max(farthest, way);
  }
  if (forces_at_x)
    system.evaluate_again(system.muscle_chunks(), x.get(), g.get());
  else
    system.evaluate(x.get(), g.get());
  if (farthest > least_motion) {
    const double share = std::min(1.0, probe / farthest);
    for (std::ptrdiff_t i = 0; i < 4 * system.rows; ++i)
      trial[static_cast<std::size_t>(i)] =
          x[static_cast<std::size_t>(i)] +
          share * (moved[static_cast<std::size_t>(i)] - x[static_cast<std::size_t>(i)]);
    const std::vector<int> chunks =
        system.chunks_with([&moves](int row) { return moves[static_cast<std::size_t>(row)] != 0; });
    system.evaluate_again(chunks, trial.get(), next_g.get());
    for (std::ptrdiff_t i = 0; i < 4 * system.free; ++i)
      g[static_cast<std::size_t>(i)] += (next_g[static_cast<std::size_t>(i)] - g[static_cast<std::size_t>(i)]) / share;
  }
  forces_at_x = false;
  if (!has_factor || factor_inverse_time_step2 != system.inverse_time_step2) {
    drop_job();
    factorise_now(x.get(), g.get());
  }
  Contacts contacts = detect(scene, moved.get(), 1);
  transform(g.get(), contacts);
  Step step{float_vector(size()), float_vector(size())};
  find_step(contacts, step);
  const double reach = std::max(farthest, longest(step.p.get()));
  if (!(reach <= longest_lead) || !std::isfinite(reach)) {
    system.sliding = sliding_before;
    return std::isfinite(reach) ? reach : 2 * longest_lead;
  }
  keep_pushes(contacts);
  advance(moved.get(), step.p.get(), std::min(1.0, 2 * options.longest_lead / reach), x.get());
  fresh = false;
  return reach;
}

SolveStatistics TissueEngine::solve(const MatrixX3d& pins, ContactScene* scene) {
  const auto start = std::chrono::steady_clock::now();
  if (pins.rows() != system.body.rest.rows() || !pins.allFinite())
    reject("tissue solve", "needs a finite position for every vertex");
  ++counts.solves;
  take_job();
  const std::vector<double> backup(x.get(), x.get() + 4 * system.rows);
  int iterations = 0;
  const double lead = settled ? predict(pins, scene, options.longest_lead) : 0;
  if (!settled) {
    for (std::ptrdiff_t r = system.free; r < system.rows; ++r)
      Eigen::Map<Vector3d>(x.get() + 4 * r) = pins.row(system.vertex_of[r]).transpose();
    system.put_on_slides(x.get());
    system.evaluate(x.get(), g.get());
    drop_job();
    factorise_now(x.get(), g.get());
  } else if (lead > options.longest_lead) {
    // A jump: go there in parts, so that lips meet where they would meet in motion.
    const std::vector<float> stretch(system.blocks.stretch.get(), system.blocks.stretch.get() + solved_stretch.size());
    const std::vector<Slide> slides = system.body.slides;
    MatrixX3d from = pins;
    system.store(x.get(), from);
    constexpr double most_parts = 50;
    const int parts = static_cast<int>(std::clamp(std::ceil(lead / options.longest_lead), 2.0, most_parts));
    for (int part = 1; part <= parts; ++part) {
      const double share = static_cast<double>(part) / parts;
      for (std::size_t i = 0; i < stretch.size(); ++i)
        system.blocks.stretch[i] =
            static_cast<float>(1 - share) * solved_stretch[i] + static_cast<float>(share) * stretch[i];
      for (std::size_t s = 0; s < slides.size(); ++s) {
        Slide& slide = system.body.slides[s];
        slide.point = (1 - share) * solved_slides[s].point + share * slides[s].point;
        slide.normal = ((1 - share) * solved_slides[s].normal + share * slides[s].normal).normalized();
        slide.bend = (1 - share) * solved_slides[s].bend + share * slides[s].bend;
      }
      predict((1 - share) * from + share * pins, scene, std::numeric_limits<double>::infinity());
      if (part < parts) iterations += descend(scene, 0, std::max(options.step_tolerance, 3e-4), 6).iterations;
    }
  }
  const bool in_one = settled && lead <= options.longest_lead;
  SolveStatistics statistics = descend(scene, in_one ? lead : 0, options.step_tolerance, options.max_iterations);
  statistics.iterations += iterations;
  counts.iterations += statistics.iterations;
  if (!std::all_of(x.get(), x.get() + 4 * system.rows, [](double value) { return std::isfinite(value); })) {
    std::copy(backup.begin(), backup.end(), x.get());
    statistics.converged = false;
    has_factor = forces_at_x = false;
  }
  settled = statistics.converged;
  remember_targets();
  ++served;
  if (job_due < 0 && has_factor &&
      (statistics.iterations > options.refresh_iterations || served >= options.refresh_solves))
    start_job();
  system.store(x.get(), positions);
  statistics.volume_change = system.volume(x.get()) / system.rest_volume - 1;
  statistics.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return statistics;
}

}  // namespace phiz
