// SPDX-License-Identifier: GPL-3.0-or-later
// phiz template builtin: makes a head from parameters. Its other verb: template_check.cpp.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "options.h"
#include "phiz/anatomy/builtin/builtin_head.h"
#include "phiz/core/progress.h"
#include "phiz/io/container.h"
#include "phiz/io/output_file.h"
#include "report.h"
#include "verbs.h"

namespace phiz {

namespace {

struct BuiltinArguments {
  std::string size = "standard";
  std::optional<std::uint64_t> person;
  std::string output;
  Report report;
};

void make_builtin(const BuiltinArguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  BuiltinOptions options;
  options.size = head_size(arguments.size);
  options.person = arguments.person;
  options.report = announce;
  require_writable(arguments.output);
  const HeadTemplate head = build_builtin_head(options);
  save(arguments.output, head);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  arguments.report.print(
      fmt::format("{}: {}, {} tets ({} soft), {} skin vertices, {} expressions, {} muscles, {:.1f} s\n",
                  arguments.output, head.name, head.volume.T.rows(), soft_tets(head).size(), head.skin.V.rows(),
                  head.expressions.size(), head.muscles.size(), seconds));
  arguments.report.write({{"file", arguments.output},
                          {"name", head.name},
                          {"tets", head.volume.T.rows()},
                          {"soft_tets", soft_tets(head).size()},
                          {"vertices", head.volume.V.rows()},
                          {"skin_vertices", head.skin.V.rows()},
                          {"expressions", head.expressions.size()},
                          {"muscles", head.muscles.size()},
                          {"seconds", seconds}});
}

}  // namespace

void add_template(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("template", "Make or check a head template");
  verb->require_subcommand(1);
  add_template_build(*verb);
  CLI::App* builtin = verb->add_subcommand("builtin", "Make the built-in head, or a random person of its kind");
  auto arguments = std::make_shared<BuiltinArguments>();
  builtin->add_option("--size", arguments->size, "preview (8k soft tets), standard (about 36k) or fine (150k and more)")
      ->check(CLI::IsMember({"preview", "standard", "fine"}))
      ->capture_default_str();
  builtin->add_option("--person", arguments->person, "Seed of a random person; the mean person without")
      ->type_name("SEED");
  builtin->add_option("-o,--output", arguments->output, "The head, a .phiz file")
      ->required()
      ->check(phiz_name())
      ->type_name("FILE");
  add_report(*builtin, arguments->report);
  builtin->footer("Example:\n  phiz template builtin --size standard --person 7 -o head.phiz");
  builtin->callback([arguments] { make_builtin(*arguments); });
  add_template_check(*verb);
}

}  // namespace phiz
