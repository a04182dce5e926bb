// SPDX-License-Identifier: GPL-3.0-or-later
// phiz bench: measures speed and accuracy; a source file per benchmark.
#include <CLI/CLI.hpp>

#include "verbs.h"

namespace phiz {

void add_bench(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("bench", "Measure speed and accuracy");
  verb->footer("Example:\n  phiz bench volumetric --frames 240 --json bench.json");
  verb->require_subcommand(1);
  add_bench_volumetric(*verb);
  add_bench_forward(*verb);
  add_bench_torture(*verb);
}

}  // namespace phiz
