// SPDX-License-Identifier: GPL-3.0-or-later
// phiz bench volumetric: measures the animation solve.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "bench_report.h"
#include "phiz/core/progress.h"
#include "phiz/face/volumetric_bench.h"
#include "verbs.h"

namespace phiz {

namespace {

void run_volumetric(const BenchArguments& arguments) {
  const FaceModel model = bench_model(arguments);
  VolumetricBenchOptions options;
  options.frames = arguments.frames > 0 ? arguments.frames : arguments.quick ? 40 : 240;
  options.reference_frames = arguments.quick ? 0 : 12;
  options.thread_scaling = !arguments.quick;
  const Performance performance = bench_frames(arguments, options.frames);
  VolumetricBench bench;
  {
    Progress progress("frames", options.frames);
    options.on_frame = [&progress] { progress.advance(); };
    bench = bench_volumetric(model, performance, options);
  }
  nlohmann::json report = bench_json("volumetric", model);
  report["metrics"] = {{"soft_tets", bench.soft_tets},
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
                       {"thread_scaling", or_null(bench.thread_scaling)}};
  report["series"] = {{"ms", bench.ms},
                      {"iterations", bench.iterations},
                      {"contacts", bench.contacts},
                      {"skin_error_mm", bench.skin_error_mm}};
  arguments.report.write(std::move(report));
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

void add_bench_volumetric(CLI::App& verb) {
  CLI::App* volumetric = verb.add_subcommand(
      "volumetric", "The animation solve with contact, and its distance from an independent solver");
  auto arguments = std::make_shared<BenchArguments>();
  add_bench_options(*volumetric, *arguments);
  add_bench_frames(*volumetric, *arguments, "the independent solver");
  volumetric->footer("Example:\n  phiz bench volumetric --frames 240 --json bench.json");
  volumetric->callback([arguments] { run_volumetric(*arguments); });
}

}  // namespace phiz
