// SPDX-License-Identifier: GPL-3.0-or-later
// phiz bench forward: measures the real-time engine and judges it by the reference engine and by IPOPT.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "bench_report.h"
#include "inputs.h"
#include "phiz/anatomy/builtin/builtin_head.h"
#include "phiz/core/measure.h"
#include "phiz/core/progress.h"
#include "phiz/face/forward_bench.h"
#include "verbs.h"
#ifdef PHIZ_WITH_IPOPT
#include "phiz/elasticity/tissue_ipopt.h"
#endif

namespace phiz {

namespace {

struct ForwardArguments : BenchArguments {
  std::string fine;
};

StaticEngine ipopt(const TissueSolverOptions& asked) {
#ifdef PHIZ_WITH_IPOPT
  IpoptStaticOptions options;
  // It need not be more exact than the engine that it is compared with.
  options.residual_tolerance = asked.residual_tolerance;
  options.state_tolerance = asked.step_tolerance;
  options.penetration_tolerance = asked.penetration_tolerance;
  return [options](const TissueEnergy& energy, MatrixX3d& x, ContactScene* contacts, Trace* trace) {
    IpoptStaticOptions traced = options;
    traced.trace = trace;
    return solve_static_with_ipopt(energy, x, traced, contacts);
  };
#else
  static_cast<void>(asked);
  return {};
#endif
}

FaceModel fine_model(const std::string& name) {
  if (name != "builtin") return load_model(name);
  BuiltinOptions options;
  options.size = HeadSize::fine;
  options.report = announce;
  return model_of(build_builtin_head(options));
}

std::optional<double> if_measured(const FrameTimes& times, double value) {
  return times.ms.empty() ? std::nullopt : std::optional<double>(value);
}

nlohmann::json metrics(const ForwardBench& bench) {
  const FrameTimes& times = bench.times;
  nlohmann::json out = {{"soft_tets", bench.soft_tets},
                        {"frames", bench.frames},
                        {"threads", bench.threads},
                        {"setup_ms", bench.setup_ms},
                        {"ms_median", times.median()},
                        {"ms_p95", times.p95()},
                        {"ms_max", times.most()},
                        {"iterations_median", quantile(times.iterations, 0.5)},
                        {"iterations_max", quantile(times.iterations, 1)},
                        {"contacts_max", bench.contacts_max},
                        {"frames_not_converged", times.not_converged},
                        {"residual_max", quantile(bench.residual, 1)},
                        {"penetration_mm_max", quantile(bench.penetration_mm, 1)},
                        {"volume_change_max", bench.volume_change_max},
                        {"factorisations", bench.factorisations},
                        {"projections", bench.projections},
                        {"peak_rss_mib", bench.peak_rss_mib}};
  const bool judged = !bench.reference.empty();
  std::vector<double> reference_ms;
  for (const JudgedFrame& frame : bench.reference) reference_ms.push_back(frame.statistics.milliseconds);
  out["skin_error_mm_max"] = or_null(bench.skin_error_mm_max());
  out["skin_error_own_start_mm_max"] = or_null(bench.skin_error_own_start_mm_max());
  out["reference_converged"] = judged ? nlohmann::json(bench.reference_converged()) : nlohmann::json(nullptr);
  out["reference_ms_median"] = or_null(judged ? std::optional<double>(quantile(reference_ms, 0.5)) : std::nullopt);
  out["ipopt_ms_median"] = or_null(bench.rival_ms_median());
  out["ipopt_ratio"] = or_null(bench.rival_ratio());
  out["ipopt_converged"] = bench.rival.empty() ? nlohmann::json(nullptr) : nlohmann::json(bench.rival_converged());
  out["dynamic_ms_median"] = or_null(if_measured(bench.dynamic, bench.dynamic.median()));
  out["dynamic_ms_p95"] = or_null(if_measured(bench.dynamic, bench.dynamic.p95()));
  out["dynamic_not_converged"] = or_null(if_measured(bench.dynamic, bench.dynamic.not_converged));
  const bool finer = !bench.fine.ms.empty();
  out["fine_soft_tets"] = finer ? nlohmann::json(bench.fine_soft_tets) : nlohmann::json(nullptr);
  out["fine_ms_median"] = or_null(if_measured(bench.fine, bench.fine.median()));
  out["fine_ratio"] = or_null(bench.fine_ratio());
  out["thread_scaling"] = or_null(bench.thread_scaling);
  return out;
}

nlohmann::json judged_series(const std::vector<JudgedFrame>& frames) {
  nlohmann::json out = nlohmann::json::array();
  for (const JudgedFrame& frame : frames)
    out.push_back({{"frame", frame.frame},
                   {"skin_error_mm", or_null(frame.skin_error_mm)},
                   {"skin_error_own_start_mm", or_null(frame.own_start_error_mm)},
                   {"converged", frame.statistics.converged},
                   {"residual", frame.statistics.residual},
                   {"iterations", frame.statistics.iterations},
                   {"contacts", frame.statistics.contacts},
                   {"ms", frame.statistics.milliseconds}});
  return out;
}

nlohmann::json series(const ForwardBench& bench) {
  nlohmann::json dial = nlohmann::json::array(), trace = nlohmann::json::array();
  for (const DialSetting& setting : bench.dial)
    dial.push_back({{"step_tolerance_mm", 1e3 * setting.step_tolerance},
                    {"ms_median", setting.times.median()},
                    {"ms_p95", setting.times.p95()},
                    {"iterations_mean", setting.times.mean_iterations()},
                    {"frames_not_converged", setting.times.not_converged},
                    {"residual_max", setting.residual_max},
                    {"skin_error_mm_max", or_null(setting.skin_error_mm_max)}});
  for (const EngineTrace& way : bench.traces)
    for (const TraceEntry& entry : way.entries)
      trace.push_back({{"engine", way.engine == "rival" ? "IPOPT" : way.engine},
                       {"frame", way.frame},
                       {"iteration", entry.iteration},
                       {"round", entry.round},
                       {"residual", entry.residual},
                       {"contacts", entry.contacts},
                       {"step_mm", 1e3 * entry.last_step},
                       {"ms", entry.milliseconds}});
  return {{"ms", bench.times.ms},
          {"iterations", bench.times.iterations},
          {"residual", bench.residual},
          {"penetration_mm", bench.penetration_mm},
          {"dynamic_ms", bench.dynamic.ms},
          {"dynamic_iterations", bench.dynamic.iterations},
          {"fine_ms", bench.fine.ms},
          {"reference", judged_series(bench.reference)},
          {"ipopt", judged_series(bench.rival)},
          {"dial", dial},
          {"trace", trace}};
}

std::string summary(const std::string& head, const ForwardBench& bench) {
  const FrameTimes& times = bench.times;
  std::string text = fmt::format(
      "{}: {} soft tets, {} frames, {} threads\n"
      "  static: median {:.1f} ms, 95 % {:.1f} ms, most {:.1f} ms; {} of the frames did not converge\n"
      "  residual at most {:.1e}, penetration at most {:.4f} mm, volume change at most {:.2f} %, memory {:.0f} MiB\n",
      head, bench.soft_tets, bench.frames, bench.threads, times.median(), times.p95(), times.most(),
      times.not_converged, quantile(bench.residual, 1), quantile(bench.penetration_mm, 1),
      100 * bench.volume_change_max, bench.peak_rss_mib);
  if (const auto error = bench.skin_error_mm_max())
    text += fmt::format("  skin against the reference engine: at most {:.4f} mm{}\n", *error,
                        bench.reference_converged() ? "" : ", but that did not converge in every frame");
  for (const DialSetting& setting : bench.dial)
    text += fmt::format(
        "  steps below {:g} mm: median {:.1f} ms, {:.1f} iterations{}\n", 1e3 * setting.step_tolerance,
        setting.times.median(), setting.times.mean_iterations(),
        setting.skin_error_mm_max ? fmt::format(", skin within {:.4f} mm", *setting.skin_error_mm_max) : std::string());
  if (!bench.dynamic.ms.empty())
    text += fmt::format("  dynamic: median {:.1f} ms, 95 % {:.1f} ms a step\n", bench.dynamic.median(),
                        bench.dynamic.p95());
  if (const auto ratio = bench.rival_ratio())
    text += fmt::format("  IPOPT: median {:.0f} ms, {:.0f} times as long{}\n", *bench.rival_ms_median(), *ratio,
                        bench.rival_converged() ? "" : ", not converged in every frame");
  if (const auto ratio = bench.fine_ratio())
    text += fmt::format("  fine head: {} soft tets, median {:.1f} ms, {:.2f} times as long per tet\n",
                        bench.fine_soft_tets, bench.fine.median(), *ratio);
  if (bench.thread_scaling)
    text += fmt::format("  two threads are {:.2f} times as fast as one\n", *bench.thread_scaling);
  return text;
}

void run_forward(const ForwardArguments& arguments) {
  const FaceModel model = bench_model(arguments);
  ForwardBenchOptions options;
  options.frames = arguments.frames > 0 ? arguments.frames : arguments.quick ? 40 : 180;
  if (arguments.quick)
    options.reference_frames = options.own_start_frames = options.rival_frames = 0;
  else
    options.rival = ipopt(options.simulation.solve);
  if (!arguments.fine.empty() && !arguments.quick) options.fine = [&arguments] { return fine_model(arguments.fine); };
  options.on_part = announce;
  const ForwardBench bench = bench_forward(model, bench_frames(arguments, options.frames), options);
  nlohmann::json report = bench_json("forward", model);
  report["metrics"] = metrics(bench);
  report["series"] = series(bench);
  arguments.report.write(std::move(report));
  arguments.report.print(summary(model.head.name, bench));
}

}  // namespace

void add_bench_forward(CLI::App& verb) {
  CLI::App* forward = verb.add_subcommand("forward",
                                          "The real-time engine on a face moved by its muscles, judged by the "
                                          "reference engine and by IPOPT");
  auto arguments = std::make_shared<ForwardArguments>();
  add_bench_options(*forward, *arguments);
  add_bench_frames(*forward, *arguments, "other engines");
  forward
      ->add_option("--fine", arguments->fine,
                   "A finer head to measure, too: builtin (built now, minutes), or one in a .phiz file")
      ->type_name("builtin|FILE");
  forward->footer("Example:\n  phiz bench forward --performance recording.csv --json forward.json");
  forward->callback([arguments] { run_forward(*arguments); });
}

}  // namespace phiz
