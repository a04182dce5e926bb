// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/face/forward_bench.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "phiz/core/error.h"
#include "phiz/core/measure.h"
#include "phiz/core/parallel.h"
#include "phiz/core/progress.h"
#include "phiz/elasticity/tissue_newton.h"
#include "phiz/face/animate.h"
#include "phiz/face/static_problem.h"

namespace phiz {

namespace {

struct Frames {
  std::vector<VectorXd> weights;
  std::vector<Eigen::Isometry3d> head;
  double duration = 1.0 / 60;  ///< of each, seconds

  int count() const { return static_cast<int>(weights.size()); }
};

Frames frames_of(const FaceModel& model, const Performance& performance, int count) {
  const ExpressionMatch match = match_expressions(model, performance);
  const AnimateOptions usual;
  Frames frames;
  for (Eigen::Index f = 0; f < std::min<Eigen::Index>(count, performance.time.size()); ++f) {
    frames.weights.push_back(shape_weights(match, performance, f));
    frames.head.push_back(head_pose(performance, f, usual.head_pivot));
  }
  if (frames.count() == 0) reject("performance", "has no frames to measure with");
  if (frames.count() > 1) frames.duration = performance.time[frames.count() - 1] / (frames.count() - 1);
  return frames;
}

/// `count` of the numbers from 0 to all - 1, evenly spaced.
std::vector<int> spread(int all, int count) {
  std::vector<int> out;
  for (int k = 0; k < std::min(count, all); ++k)
    out.push_back(static_cast<int>((static_cast<double>(k) + 0.5) * all / std::min(count, all)));
  return out;
}

void count_frame(FrameTimes& times, int frame, double ms, const SolveStatistics& statistics) {
  if (frame > 0) {
    times.ms.push_back(ms);
    times.iterations.push_back(statistics.iterations);
  }
  times.not_converged += statistics.converged ? 0 : 1;
}

using OnFrame = std::function<void(int frame, const MuscleSimulation& simulation, const SolveStatistics& statistics)>;

FrameTimes play(MuscleSimulation& simulation, const Frames& frames, int count, const OnFrame& on_frame = {}) {
  FrameTimes times;
  for (int f = 0; f < std::min(count, frames.count()) && !interrupted(); ++f) {
    const Stopwatch watch;
    const SolveStatistics statistics = simulation.solve_static(frames.weights[static_cast<std::size_t>(f)]);
    const MatrixX3d drawn = simulation.skin();
    count_frame(times, f, watch.milliseconds(), statistics);
    if (on_frame) on_frame(f, simulation, statistics);
  }
  return times;
}

FrameTimes play_dynamic(const FaceModel& model, const std::vector<ActivationShape>& shapes, const Frames& frames,
                        MuscleOptions options, double step_tolerance) {
  options.dynamic = true;
  options.time_step = frames.duration;
  options.solve.step_tolerance = step_tolerance;
  MuscleSimulation simulation(model, shapes, options);
  simulation.rest(frames.head[0]);
  constexpr int gently = 10;  // steps into the first frame
  for (int k = 1; k <= gently; ++k)
    simulation.step(frames.duration, k / static_cast<double>(gently) * frames.weights[0], frames.head[0]);
  FrameTimes times;
  for (int f = 0; f < frames.count() && !interrupted(); ++f) {
    const auto frame = static_cast<std::size_t>(f);
    const Stopwatch watch;
    const SolveStatistics statistics = simulation.step(frames.duration, frames.weights[frame], frames.head[frame]);
    const MatrixX3d drawn = simulation.skin();
    count_frame(times, f, watch.milliseconds(), statistics);
  }
  return times;
}

double median_with_threads(const FaceModel& model, const std::vector<ActivationShape>& shapes, const Frames& frames,
                           const ForwardBenchOptions& options, int threads) {
  const ThreadLimit limit(threads);
  MuscleOptions how = options.simulation;
  how.solve.background = threads > 1 && how.solve.background;
  MuscleSimulation simulation(model, shapes, how);
  return play(simulation, frames, options.scaling_frames).median();
}

/// The real-time engine in some frames, asked for nearly all that single precision gives.
std::vector<EngineTrace> real_time_traces(const FaceModel& model, const std::vector<ActivationShape>& shapes,
                                          const Frames& frames, const MuscleOptions& options,
                                          const std::vector<int>& wanted) {
  std::vector<EngineTrace> traces;
  MuscleSimulation simulation(model, shapes, options);
  for (int f = 0; f < frames.count() && traces.size() < wanted.size() && !interrupted(); ++f) {
    const bool traced = f == wanted[traces.size()];
    EngineTrace trace{"real-time", f, {}};
    simulation.solve_options() = options.solve;
    if (traced) {
      simulation.solve_options().step_tolerance = 1e-8;
      simulation.solve_options().residual_tolerance = 1e-5;
      simulation.solve_options().trace = &trace.entries;
    }
    simulation.solve_static(frames.weights[static_cast<std::size_t>(f)]);
    if (traced) traces.push_back(std::move(trace));
  }
  return traces;
}

std::optional<double> largest(const std::vector<double>& values) {
  return values.empty() ? std::nullopt : std::optional<double>(quantile(values, 1));
}

StaticProblem::Solve reference_engine(Trace* trace) {
  NewtonStaticOptions options;
  options.trace = trace;
  return [options](const TissueEnergy& energy, MatrixX3d& x, ContactScene* contacts) {
    return solve_static(energy, x, options, contacts);
  };
}

/// A benchmark on its way, part by part.
class Run {
 public:
  Run(const FaceModel& model, const Performance& performance, const ForwardBenchOptions& options)
      : model_(model),
        performance_(performance),
        options_(options),
        frames_(frames_of(model, performance, options.frames)),
        tissue_(head_tissue(model.head, options.simulation.tissue)),
        shapes_(estimate_activations(model, tissue_)),
        problem_(model, shapes_, options.simulation),
        judged_(spread(frames_.count(), options.reference_frames)) {
    for (const int f : judged_)
      for (const int g : {std::max(0, f - 1), f}) states_[g] = {};
  }

  ForwardBench all() {
    play_static();
    if (options_.dynamic_step_tolerance > 0) {
      begin("dynamic frames");
      bench_.dynamic = play_dynamic(model_, shapes_, frames_, options_.simulation, options_.dynamic_step_tolerance);
    }
    scale_threads();
    judge();
    trace_real_time();
    turn_dial();
    if (options_.rival) play_rival();
    if (options_.fine) play_fine();
    return std::move(bench_);
  }

 private:
  void begin(const char* part) const {
    if (options_.on_part && !interrupted()) options_.on_part(part);
  }
  const VectorXd& weights(int frame) const { return frames_.weights[static_cast<std::size_t>(frame)]; }
  /// Of the judged frames that have a frame before, `count`.
  std::vector<int> some_judged(int count) const {
    std::vector<int> out;
    for (const int k : spread(static_cast<int>(judged_.size()), count))
      if (const int f = judged_[static_cast<std::size_t>(k)]; f > 0) out.push_back(f);
    return out;
  }

  void play_static() {
    begin("static frames");
    const Stopwatch setup;
    MuscleSimulation simulation(model_, shapes_, options_.simulation);
    bench_.setup_ms = setup.milliseconds();
    bench_.soft_tets = tissue_.soft.size();
    bench_.frames = frames_.count();
    bench_.threads = thread_count();
    bench_.times = play(simulation, frames_, frames_.count(), [this](int f, const auto& now, const auto& statistics) {
      bench_.residual.push_back(statistics.residual);
      bench_.penetration_mm.push_back(1e3 * now.penetration());
      bench_.volume_change_max = std::max(bench_.volume_change_max, std::abs(statistics.volume_change));
      bench_.contacts_max = std::max(bench_.contacts_max, statistics.contacts);
      if (const auto kept = states_.find(f); kept != states_.end()) kept->second = now.positions();
    });
    bench_.factorisations = simulation.solver().counts().factorisations;
    bench_.projections = simulation.solver().counts().projections;
    bench_.peak_rss_mib = peak_memory_mib();
  }

  void scale_threads() {
    if (options_.scaling_frames < 1 || bench_.threads < 2) return;
    begin("threads");
    const double two = median_with_threads(model_, shapes_, frames_, options_, 2);
    if (two > 0) bench_.thread_scaling = median_with_threads(model_, shapes_, frames_, options_, 1) / two;
  }

  void judge() {
    const std::vector<int> own_start = some_judged(options_.own_start_frames);
    for (const int f : judged_) {
      if (interrupted()) return;
      begin("reference engine");
      JudgedFrame frame;
      frame.frame = f;
      MatrixX3d& x = exact_[f] = states_[f];
      frame.statistics = problem_.solve(weights(f), x, reference_engine(nullptr));
      frame.skin_error_mm = 1e3 * problem_.skin_distance(x, states_[f]);
      if (std::find(own_start.begin(), own_start.end(), f) != own_start.end()) judge_from_own_start(frame);
      bench_.reference.push_back(frame);
    }
  }

  void judge_from_own_start(JudgedFrame& frame) {
    const int f = frame.frame;
    MatrixX3d own = states_[f - 1];
    problem_.solve(weights(f - 1), own, reference_engine(nullptr));
    EngineTrace trace{"reference", f, {}};
    const SolveStatistics statistics = problem_.solve(weights(f), own, reference_engine(&trace.entries));
    frame.statistics.converged = frame.statistics.converged && statistics.converged;
    frame.own_start_error_mm = 1e3 * problem_.skin_distance(own, states_[f]);
    bench_.traces.push_back(std::move(trace));
  }

  void trace_real_time() {
    const std::vector<int> wanted = some_judged(std::max(options_.rival_frames, options_.own_start_frames));
    for (EngineTrace& trace : real_time_traces(model_, shapes_, frames_, options_.simulation, wanted))
      bench_.traces.push_back(std::move(trace));
  }

  void turn_dial() {
    for (const double step_tolerance : options_.dial) {
      begin("accuracy dial");
      MuscleOptions how = options_.simulation;
      how.solve.step_tolerance = step_tolerance;
      MuscleSimulation simulation(model_, shapes_, how);
      DialSetting setting;
      setting.step_tolerance = step_tolerance;
      std::vector<double> errors;
      setting.times = play(simulation, frames_, frames_.count(), [&](int f, const auto& now, const auto& statistics) {
        setting.residual_max = std::max(setting.residual_max, statistics.residual);
        if (const auto known = exact_.find(f); known != exact_.end())
          errors.push_back(1e3 * problem_.skin_distance(known->second, now.positions()));
      });
      setting.skin_error_mm_max = largest(errors);
      bench_.dial.push_back(std::move(setting));
    }
  }

  void play_rival() {
    for (const int f : some_judged(options_.rival_frames)) {
      if (interrupted() || !exact_.contains(f)) return;
      begin("rival");
      EngineTrace trace{"rival", f, {}};
      JudgedFrame frame;
      frame.frame = f;
      MatrixX3d x = states_[f - 1];
      frame.statistics =
          problem_.solve(weights(f), x, [&](const TissueEnergy& energy, MatrixX3d& from, ContactScene* contacts) {
            return options_.rival(energy, from, contacts, &trace.entries);
          });
      frame.skin_error_mm = 1e3 * problem_.skin_distance(exact_[f], x);
      bench_.rival.push_back(frame);
      bench_.traces.push_back(std::move(trace));
    }
  }

  void play_fine() {
    if (interrupted()) return;
    begin("fine head");
    const FaceModel fine = options_.fine();
    const HeadTissue tissue = head_tissue(fine.head, options_.simulation.tissue);
    MuscleSimulation simulation(fine, estimate_activations(fine, tissue), options_.simulation);
    bench_.fine_soft_tets = tissue.soft.size();
    bench_.fine = play(simulation, frames_of(fine, performance_, options_.frames), frames_.count());
  }

  const FaceModel& model_;
  const Performance& performance_;
  const ForwardBenchOptions& options_;
  Frames frames_;
  HeadTissue tissue_;
  std::vector<ActivationShape> shapes_;
  StaticProblem problem_;
  std::vector<int> judged_;
  std::map<int, MatrixX3d> states_;  ///< of the real-time engine in the judged frames and those before
  std::map<int, MatrixX3d> exact_;   ///< of the reference engine in the judged frames
  ForwardBench bench_;
};

}  // namespace

double FrameTimes::median() const {
  return quantile(ms, 0.5);
}
double FrameTimes::p95() const {
  return quantile(ms, 0.95);
}
double FrameTimes::most() const {
  return quantile(ms, 1);
}
double FrameTimes::mean_iterations() const {
  return iterations.empty()
             ? 0
             : std::reduce(iterations.begin(), iterations.end()) / static_cast<double>(iterations.size());
}

bool ForwardBench::reference_converged() const {
  return std::all_of(reference.begin(), reference.end(),
                     [](const JudgedFrame& frame) { return frame.statistics.converged; });
}

bool ForwardBench::rival_converged() const {
  return std::all_of(rival.begin(), rival.end(), [](const JudgedFrame& frame) { return frame.statistics.converged; });
}

std::optional<double> ForwardBench::skin_error_mm_max() const {
  std::vector<double> errors;
  for (const JudgedFrame& frame : reference) errors.push_back(frame.skin_error_mm);
  return largest(errors);
}

std::optional<double> ForwardBench::skin_error_own_start_mm_max() const {
  std::vector<double> errors;
  for (const JudgedFrame& frame : reference)
    if (frame.own_start_error_mm) errors.push_back(*frame.own_start_error_mm);
  return largest(errors);
}

std::optional<double> ForwardBench::rival_ms_median() const {
  std::vector<double> ms;
  for (const JudgedFrame& frame : rival) ms.push_back(frame.statistics.milliseconds);
  return ms.empty() ? std::nullopt : std::optional<double>(quantile(ms, 0.5));
}

std::optional<double> ForwardBench::rival_ratio() const {
  if (rival.empty() || times.ms.empty()) return std::nullopt;
  return *rival_ms_median() / times.median();
}

std::optional<double> ForwardBench::fine_ratio() const {
  if (fine.ms.empty() || times.ms.empty()) return std::nullopt;
  return fine.median() / (times.median() * static_cast<double>(fine_soft_tets) / static_cast<double>(soft_tets));
}

ForwardBench bench_forward(const FaceModel& model, const Performance& performance, const ForwardBenchOptions& options) {
  return Run(model, performance, options).all();
}

}  // namespace phiz
