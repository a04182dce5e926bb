// SPDX-License-Identifier: GPL-3.0-or-later
/// What the verbs of `bench` have in common.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "phiz/face/face_model.h"
#include "phiz/face/performance.h"
#include "report.h"

namespace CLI {
class App;
}

namespace phiz {

struct BenchArguments {
  std::string head = "builtin";
  std::string performance;
  int frames = 0;  ///< 0: the benchmark's own number
  bool quick = false;
  Report report;
};

/// Adds --template, and --json.
void add_bench_options(CLI::App& verb, BenchArguments& arguments);
/// Adds --performance, --frames and --quick, which `leaves_out` something.
void add_bench_frames(CLI::App& verb, BenchArguments& arguments, const std::string& leaves_out);

/// The built-in head of a size as a model (slow), or the model in a file.
FaceModel bench_model(const BenchArguments& arguments);
/// The performance that was asked for, or the made-up one.
Performance bench_frames(const BenchArguments& arguments, int frames);

/// {"bench", "phiz", "commit", "machine", "template"}: what every benchmark says besides metrics and series.
nlohmann::json bench_json(const std::string& name, const FaceModel& model);
nlohmann::json or_null(const std::optional<double>& value);

}  // namespace phiz
