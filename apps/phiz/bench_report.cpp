// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench_report.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <thread>

#include "inputs.h"
#include "options.h"
#include "phiz/anatomy/builtin/builtin_head.h"
#include "phiz/core/progress.h"
#include "phiz/core/version.h"
#include "phiz/face/volumetric_bench.h"

namespace phiz {

namespace {

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

}  // namespace

void add_bench_options(CLI::App& verb, BenchArguments& arguments) {
  verb.add_option("--template", arguments.head, "builtin, or a head or model in a .phiz file")
      ->capture_default_str()
      ->type_name("builtin|FILE");
  add_report(verb, arguments.report);
}

void add_bench_frames(CLI::App& verb, BenchArguments& arguments, const std::string& leaves_out) {
  verb.add_option("--performance", arguments.performance,
                  "A recording of Live Link Face (CSV) or a .phiz performance; made up without")
      ->type_name("FILE");
  verb.add_option("--frames", arguments.frames, "Number of frames")->check(between(1, 1e6));
  verb.add_flag("--quick", arguments.quick, "A short run on the preview head, without " + leaves_out);
}

FaceModel bench_model(const BenchArguments& arguments) {
  if (arguments.head != "builtin") return load_model(arguments.head);
  BuiltinOptions options;
  options.size = arguments.quick ? HeadSize::preview : HeadSize::standard;
  options.report = announce;
  return model_of(build_builtin_head(options));
}

Performance bench_frames(const BenchArguments& arguments, int frames) {
  return arguments.performance.empty() ? bench_performance(frames) : load_any_performance(arguments.performance);
}

nlohmann::json bench_json(const std::string& name, const FaceModel& model) {
  return {{"bench", name},
          {"phiz", version()},
          {"commit", commit()},
          {"machine", machine()},
          {"template", model.head.name}};
}

nlohmann::json or_null(const std::optional<double>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json(nullptr);
}

}  // namespace phiz
