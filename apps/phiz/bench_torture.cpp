// SPDX-License-Identifier: GPL-3.0-or-later
// phiz bench torture: random poses, within range and beyond, for the real-time engine.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>

#include "bench_report.h"
#include "options.h"
#include "phiz/core/measure.h"
#include "phiz/core/progress.h"
#include "phiz/face/torture.h"
#include "verbs.h"

namespace phiz {

namespace {

struct TortureArguments : BenchArguments {
  TortureOptions options;
};

/// What is said of the poses within range, or of those beyond.
struct Tally {
  std::vector<double> ms, iterations, residual, penetration_mm, volume_change;
  int not_converged = 0, not_finite = 0, errors = 0;
};

Tally tally(const std::vector<TortureResult>& results, bool beyond) {
  Tally out;
  for (const TortureResult& result : results) {
    if (result.beyond != beyond) continue;
    out.errors += result.error.empty() ? 0 : 1;
    out.not_finite += result.finite ? 0 : 1;
    if (!result.error.empty()) continue;
    out.ms.push_back(result.statistics.milliseconds);
    out.iterations.push_back(result.statistics.iterations);
    out.residual.push_back(result.statistics.residual);
    out.penetration_mm.push_back(1e3 * result.penetration);
    out.volume_change.push_back(std::abs(result.statistics.volume_change));
    out.not_converged += result.statistics.converged ? 0 : 1;
  }
  return out;
}

nlohmann::json as_json(const Tally& t) {
  return {{"solved", t.ms.size()},
          {"errors", t.errors},
          {"not_converged", t.not_converged},
          {"not_finite", t.not_finite},
          {"residual_max", quantile(t.residual, 1)},
          {"penetration_mm_max", quantile(t.penetration_mm, 1)},
          {"volume_change_max", quantile(t.volume_change, 1)},
          {"iterations_median", quantile(t.iterations, 0.5)},
          {"iterations_max", quantile(t.iterations, 1)},
          {"ms_median", quantile(t.ms, 0.5)},
          {"ms_max", quantile(t.ms, 1)}};
}

std::string line(const char* which, const Tally& t) {
  return fmt::format(
      "  {}: {} poses solved, {} errors, {} did not converge, {} not finite; residual at most {:.1e}, penetration at "
      "most {:.4f} mm, "
      "volume change at most {:.1f} %; median {:.0f} iterations, {:.0f} ms\n",
      which, t.ms.size(), t.errors, t.not_converged, t.not_finite, quantile(t.residual, 1),
      quantile(t.penetration_mm, 1), 100 * quantile(t.volume_change, 1), quantile(t.iterations, 0.5),
      quantile(t.ms, 0.5));
}

std::string describe(const TortureResult& result) {
  if (!result.error.empty())
    return fmt::format("{}{} from {}: error: {}; {}", result.beyond ? "beyond " : "", result.number,
                       result.from_neutral ? "neutral" : "the one before", result.error, result.what);
  return fmt::format("{}{} from {}: {}, penetration {:.4f} mm, last step {:.4f} mm, volume {:+.1f} %; {}",
                     result.beyond ? "beyond " : "", result.number, result.from_neutral ? "neutral" : "the one before",
                     brief_report(result.statistics), 1e3 * result.penetration, 1e3 * result.statistics.last_step,
                     100 * result.statistics.volume_change, result.what);
}

void run_torture(const TortureArguments& arguments) {
  constexpr double deep = 1e-4;  // metres
  const FaceModel model = bench_model(arguments);
  nlohmann::json failures = nlohmann::json::array();
  const std::vector<TortureResult> results = torture(model, arguments.options, [&](const TortureResult& result) {
    if (result.error.empty() && result.statistics.converged && result.finite && result.penetration <= deep) return;
    announce(describe(result));
    failures.push_back(describe(result));
  });
  const Tally within = tally(results, false), beyond = tally(results, true);
  nlohmann::json report = bench_json("torture", model);
  report["metrics"] = {{"within", as_json(within)}, {"beyond", as_json(beyond)}};
  report["series"] = {{"failures", failures}};
  arguments.report.write(std::move(report));
  arguments.report.print(model.head.name + "\n" + line("within range", within) + line("beyond", beyond));
}

}  // namespace

void add_bench_torture(CLI::App& verb) {
  CLI::App* torture = verb.add_subcommand("torture",
                                          "Random activations and jaw poses for the real-time engine, on the "
                                          "preview head unless another one is given");
  auto arguments = std::make_shared<TortureArguments>();
  arguments->quick = true;
  add_bench_options(*torture, *arguments);
  TortureOptions& options = arguments->options;
  torture->add_option("--poses", options.poses, "Poses within range")->check(between(0, 1e6))->capture_default_str();
  torture->add_option("--beyond", options.beyond, "Poses beyond range")->check(between(0, 1e6))->capture_default_str();
  torture->add_option("--first", options.first, "Number of the first pose, to repeat a part of a run")
      ->check(between(0, 1e6))
      ->capture_default_str();
  torture->add_option("--seed", options.seed, "Seed of the poses")->capture_default_str();
  torture->footer("Example:\n  phiz bench torture --poses 100 --beyond 10");
  torture->callback([arguments] { run_torture(*arguments); });
}

}  // namespace phiz
