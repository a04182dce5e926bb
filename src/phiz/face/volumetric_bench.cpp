// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/face/volumetric_bench.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>

#include "phiz/anatomy/expression_names.h"
#include "phiz/core/measure.h"
#include "phiz/core/parallel.h"
#include "phiz/core/progress.h"
#include "phiz/elasticity/newton_reference.h"
#include "phiz/face/animate.h"
#include "phiz/face/blend.h"
#include "phiz/face/flesh.h"
#include "phiz/face/head_contacts.h"

namespace phiz {

namespace {

/// Targets of all soft tets by the scalar blend.
std::vector<TetTarget> blended_targets(const FaceModel& model, const VectorXi& soft, const VectorXd& weights) {
  std::vector<int> place(static_cast<std::size_t>(model.head.volume.T.rows()), -1);
  for (Eigen::Index t = 0; t < soft.size(); ++t) place[static_cast<std::size_t>(soft[t])] = static_cast<int>(t);
  const auto count = static_cast<std::size_t>(soft.size());
  std::vector<Vector3d> logs(count, Vector3d::Zero());
  std::vector<Matrix3d> stretches(count, Matrix3d::Identity());
  std::vector<double> volumes(count, 0.0);
  for (std::size_t m = 0; m < model.shapes.size(); ++m) {
    const VolumetricShape& shape = model.shapes[m];
    const double w = weights[static_cast<Eigen::Index>(m)];
    for (Eigen::Index i = 0; i < shape.tets.size(); ++i) {
      const int t = place[static_cast<std::size_t>(shape.tets[i])];
      if (t < 0 || std::abs(w) < 1e-5) continue;
      const auto s = shape.stretch.row(i).cast<double>().eval();
      Matrix3d S;
      S << s[0], s[3], s[4], s[3], s[1], s[5], s[4], s[5], s[2];
      const auto u = static_cast<std::size_t>(t);
      logs[u] += w * shape.log_rotation.row(i).transpose().cast<double>();
      stretches[u] += w * S;
      volumes[u] += w * excused_volume((Matrix3d::Identity() + S).determinant());
    }
  }
  std::vector<TetTarget> targets(count);
  for (std::size_t t = 0; t < count; ++t)
    targets[t] = {rotation_exponential(logs[t]) * stretches[t], stretches[t],
                  std::exp(std::clamp(volumes[t], -0.75, 0.75))};
  return targets;
}

}  // namespace

VolumetricBench bench_volumetric(const FaceModel& model, const Performance& performance,
                                 const VolumetricBenchOptions& options) {
  VolumetricBench bench;
  const Stopwatch setup;
  Simulation simulation(model, options.simulation);
  bench.setup_ms = setup.milliseconds();
  bench.soft_tets = simulation.soft_tets().size();
  bench.threads = thread_count();
  bench.frames = std::min<int>(options.frames, static_cast<int>(performance.time.size()));
  const ExpressionMatch match = match_expressions(model, performance);
  const MatrixX3d skin_rest = model.head.volume.V(model.head.skin_vertices, Eigen::all);
  std::vector<double> reference_ms;
  const int every = options.reference_frames > 0 ? std::max(1, bench.frames / options.reference_frames) : 0;
  for (int f = 0; f < bench.frames && !interrupted(); ++f) {
    const VectorXd weights = shape_weights(match, performance, f);
    const MatrixX3d before = simulation.positions();
    const Stopwatch watch;
    const SolveStatistics statistics = simulation.solve_static(weights);
    const MatrixX3d drawn = simulation.skin();
    if (f > 0) {
      bench.ms.push_back(watch.milliseconds());
      bench.iterations.push_back(statistics.iterations);
      bench.contacts.push_back(statistics.contacts);
    }
    bench.frames_not_converged += statistics.converged ? 0 : 1;
    bench.residual_max = std::max(bench.residual_max, statistics.residual);
    bench.penetration_mm_max = std::max(bench.penetration_mm_max, 1e3 * statistics.penetration);
    bench.volume_change_max = std::max(bench.volume_change_max, std::abs(statistics.volume_change));
    if (every > 0 && f % every == every / 2) {
      const VectorXi& soft = simulation.soft_tets();
      HeadContacts contacts(model.head, options.simulation.contact_options);
      contacts.place_jaw(jaw_transform(model.head.jaw, simulation.jaw()));
      MatrixX3d x = before;  // the reference finds its own way from the last frame
      place_bones(model.head, simulation.jaw(), x);
      const SolveStatistics exact = newton_reference(
          flesh_body(model.head, soft, options.simulation.weights, options.simulation.stiffness),
          blended_targets(model, soft, weights), x, options.simulation.contact ? &contacts.scene : nullptr);
      const MatrixX3d skin =
          model.head.skin.V + model.head.skin_interpolation * (x(model.head.skin_vertices, Eigen::all) - skin_rest);
      bench.skin_error_mm.push_back(1e3 * (skin - drawn).rowwise().norm().maxCoeff());
      bench.reference_converged = bench.reference_converged && exact.converged;
      reference_ms.push_back(exact.milliseconds);
    }
    if (options.on_frame) options.on_frame();
  }
  bench.ms_median = quantile(bench.ms, 0.5);
  bench.ms_p95 = quantile(bench.ms, 0.95);
  bench.ms_max = quantile(bench.ms, 1);
  bench.iterations_median = quantile(bench.iterations, 0.5);
  bench.contacts_max = quantile(bench.contacts, 1);
  if (!bench.skin_error_mm.empty()) {
    bench.skin_error_mm_max = quantile(bench.skin_error_mm, 1);
    bench.reference_ms_median = quantile(reference_ms, 0.5);
  }
  if (options.thread_scaling && bench.threads > 1) {
    const auto median_of = [&](int threads) {
      const ThreadLimit limit(threads);
      Simulation again(model, options.simulation);
      std::vector<double> ms;
      for (int f = 0; f < std::min(bench.frames, 40); ++f) {
        const Stopwatch watch;
        again.solve_static(shape_weights(match, performance, f));
        const MatrixX3d drawn = again.skin();
        if (f > 0) ms.push_back(watch.milliseconds());
      }
      return quantile(ms, 0.5);
    };
    const double all = median_of(0);
    if (all > 0) bench.thread_scaling = median_of(1) / all;
  }
  bench.peak_rss_mib = peak_memory_mib();
  return bench;
}

Performance bench_performance(int frames) {
  Performance performance;
  for (const std::string_view name : expression_names) performance.expressions.emplace_back(name);
  performance.frame_rate = 30;
  performance.time.resize(frames);
  performance.weights = MatrixXd::Zero(frames, static_cast<Eigen::Index>(performance.expressions.size()));
  performance.head = performance.left_eye = performance.right_eye = MatrixX3d::Zero(frames, 3);
  const auto wave = [](double t, double period, double shift) {
    const double s = std::sin(3.14159265358979323846 * (t / period + shift));
    return s * s;
  };
  for (int f = 0; f < frames; ++f) {
    const double t = f / performance.frame_rate;
    performance.time[f] = t;
    const auto set = [&](const char* name, double value) {
      const auto at = std::find(performance.expressions.begin(), performance.expressions.end(), name);
      performance.weights(f, at - performance.expressions.begin()) = value;
    };
    // Syllables open the jaw; lips round, close and press in between.
    const double open = 0.35 * wave(t, 0.33, 0) * (0.4 + 0.6 * wave(t, 1.7, 0.2));
    set("jawOpen", open);
    set("mouthFunnel", 0.4 * wave(t, 0.8, 0.3));
    set("mouthPucker", 0.5 * std::pow(wave(t, 2.3, 0.5), 3));
    set("mouthClose", 0.5 * open * wave(t, 0.5, 0.1));
    for (const std::string side : {"Left", "Right"}) {
      const double lag = side == "Left" ? 0.0 : 0.05;
      set(("mouthSmile" + side).c_str(), 0.7 * std::pow(wave(t, 3.1, 0.4 + lag), 3));
      set(("mouthPress" + side).c_str(), 0.6 * std::pow(wave(t, 1.1, 0.7 + lag), 4));
      set(("mouthUpperUp" + side).c_str(), 0.25 * wave(t, 0.7, 0.6 + lag));
      set(("mouthLowerDown" + side).c_str(), 0.35 * wave(t, 0.6, lag));
      set(("eyeBlink" + side).c_str(), std::pow(wave(t, 2.0, 0.45), 12));
      set(("browDown" + side).c_str(), 0.5 * std::pow(wave(t, 4.3, 0.1 + lag), 2));
      set(("cheekSquint" + side).c_str(), 0.4 * std::pow(wave(t, 3.1, 0.4 + lag), 3));
      set(("noseSneer" + side).c_str(), 0.3 * std::pow(wave(t, 5.0, 0.2), 4));
    }
    set("browInnerUp", 0.6 * std::pow(wave(t, 2.9, 0.8), 2));
    set("mouthRollLower", 0.3 * std::pow(wave(t, 1.3, 0.25), 4));
    set("jawLeft", 0.15 * wave(t, 1.9, 0.6));
  }
  return performance;
}

}  // namespace phiz
