// SPDX-License-Identifier: GPL-3.0-or-later
/// The verbs of the command, one source file each. add_VERB adds a subcommand with its options, help and example, and a
/// callback that does the work. Callbacks throw phiz::Error; main.cpp turns errors into messages and exit codes.
#pragma once

namespace CLI {
class App;
}

namespace phiz {

void add_template(CLI::App& app);
/// Parts of `template`: add its verbs `build`, `person` and `check`.
void add_template_build(CLI::App& verb);
void add_template_person(CLI::App& verb);
void add_template_check(CLI::App& verb);
void add_animate(CLI::App& app);
void add_simulate(CLI::App& app);
void add_export(CLI::App& app);
void add_inspect(CLI::App& app);
void add_render(CLI::App& app);
void add_bench(CLI::App& app);
/// Parts of `bench`.
void add_bench_volumetric(CLI::App& verb);
void add_bench_forward(CLI::App& verb);
void add_bench_torture(CLI::App& verb);

}  // namespace phiz
