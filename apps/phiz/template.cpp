// SPDX-License-Identifier: GPL-3.0-or-later
// phiz template builtin: makes a head from parameters. Its other verbs: template_build, _person, _check.
#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "made_head.h"
#include "options.h"
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
  require_writable(arguments.output);
  save_and_report(arguments.output, make_builtin_head(options), start, arguments.report, "", nlohmann::json::object());
}

}  // namespace

void add_template(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("template", "Make a head template or a person of it, or check one");
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
  add_template_person(*verb);
  add_template_check(*verb);
}

}  // namespace phiz
