// SPDX-License-Identifier: GPL-3.0-or-later
// phiz bench volumetric: measures the animation solve.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>

#include "inputs.h"
#include "options.h"
#include "phiz/anatomy/builtin/builtin_head.h"
#include "phiz/core/progress.h"
#include "phiz/core/version.h"
#include "phiz/face/volumetric_bench.h"
#include "report.h"
#include "verbs.h"

namespace phiz {

namespace {

struct BenchArguments {
  std::string head = "builtin";
  std::string performance;
  int frames = 0;
  bool quick = false;
  Report report;
};

/// The first value of a key in /proc/cpuinfo.
std::string processor(const std::string& key) {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with(key)) return line.substr(std::min(line.size(), line.find(':') + 2));
  return {};
}

nlohmann::json machine() {
  const std::string flags = processor("flags");
  const char* isa = flags.find("avx512f") != std::string::npos ? "AVX-512"
                    : flags.find("avx2") != std::string::npos  ? "AVX2"
                                                               : "other";
  return {{"cpu", processor("model name")}, {"cores", std::thread::hardware_concurrency()}, {"isa", isa}};
}

FaceModel bench_model(const BenchArguments& arguments) {
  if (arguments.head != "builtin") return load_model(arguments.head);
  BuiltinOptions options;
  options.size = arguments.quick ? HeadSize::preview : HeadSize::standard;
  options.report = announce;
  return model_of(build_builtin_head(options));
}

nlohmann::json or_null(const std::optional<double>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json(nullptr);
}

void run_volumetric(const BenchArguments& arguments) {
  const FaceModel model = bench_model(arguments);
  VolumetricBenchOptions options;
  options.frames = arguments.frames > 0 ? arguments.frames : arguments.quick ? 40 : 240;
  options.reference_frames = arguments.quick ? 0 : 12;
  options.thread_scaling = !arguments.quick;
  const Performance performance =
      arguments.performance.empty() ? bench_performance(options.frames) : load_any_performance(arguments.performance);
  VolumetricBench bench;
  {
    Progress progress("frames", options.frames);
    options.on_frame = [&progress] { progress.advance(); };
    bench = bench_volumetric(model, performance, options);
  }
  arguments.report.write({{"bench", "volumetric"},
                          {"phiz", version()},
                          {"commit", commit()},
                          {"machine", machine()},
                          {"template", model.head.name},
                          {"metrics",
                           {{"soft_tets", bench.soft_tets},
                            {"frames", bench.frames},
                            {"ms_median", bench.ms_median},
                            {"ms_p95", bench.ms_p95},
                            {"ms_max", bench.ms_max},
                            {"iterations_median", bench.iterations_median},
                            {"contacts_max", bench.contacts_max},
                            {"frames_not_converged", bench.frames_not_converged},
                            {"residual_max", bench.residual_max},
                            {"skin_error_mm_max", or_null(bench.skin_error_mm_max)},
                            {"reference_converged", bench.reference_converged},
                            {"reference_ms_median", or_null(bench.reference_ms_median)},
                            {"penetration_mm_max", bench.penetration_mm_max},
                            {"volume_change_max", bench.volume_change_max},
                            {"setup_ms", bench.setup_ms},
                            {"peak_rss_mib", bench.peak_rss_mib},
                            {"threads", bench.threads},
                            {"thread_scaling", or_null(bench.thread_scaling)}}},
                          {"series",
                           {{"ms", bench.ms},
                            {"iterations", bench.iterations},
                            {"contacts", bench.contacts},
                            {"skin_error_mm", bench.skin_error_mm}}}});
  arguments.report.print(fmt::format(
      "{}: {} soft tets, {} frames, {} threads\n"
      "  time per frame: median {:.1f} ms, 95 % {:.1f} ms, most {:.1f} ms; {} of the frames did not converge\n"
      "  skin against the independent solver: {}\n"
      "  penetration at most {:.4f} mm, volume change at most {:.2f} %, residual at most {:.1e}, memory {:.0f} MiB\n",
      model.head.name, bench.soft_tets, bench.frames, bench.threads, bench.ms_median, bench.ms_p95, bench.ms_max,
      bench.frames_not_converged,
      !bench.skin_error_mm_max ? std::string("not measured")
      : bench.reference_converged
          ? fmt::format("at most {:.4f} mm", *bench.skin_error_mm_max)
          : fmt::format("at most {:.4f} mm, but that solver did not converge in every frame", *bench.skin_error_mm_max),
      bench.penetration_mm_max, 100 * bench.volume_change_max, bench.residual_max, bench.peak_rss_mib));
}

}  // namespace

void add_bench(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("bench", "Measure speed and accuracy");
  verb->footer("Example:\n  phiz bench volumetric --frames 240 --json bench.json");
  verb->require_subcommand(1);
  CLI::App* volumetric = verb->add_subcommand(
      "volumetric", "The animation solve with contact, and its distance from an independent solver");
  auto arguments = std::make_shared<BenchArguments>();
  volumetric->add_option("--template", arguments->head, "builtin, or a head or model in a .phiz file")
      ->capture_default_str()
      ->type_name("builtin|FILE");
  volumetric
      ->add_option("--performance", arguments->performance,
                   "A recording of Live Link Face (CSV) or a .phiz performance; made up without")
      ->type_name("FILE");
  volumetric->add_option("--frames", arguments->frames, "Number of frames")->check(between(1, 1e6));
  volumetric->add_flag("--quick", arguments->quick, "A short run on the preview head, without the independent solver");
  add_report(*volumetric, arguments->report);
  volumetric->footer("Example:\n  phiz bench volumetric --frames 240 --json bench.json");
  volumetric->callback([arguments] { run_volumetric(*arguments); });
}

}  // namespace phiz
