// SPDX-License-Identifier: GPL-3.0-or-later
// phiz inspect: what a file holds, and whether it is sound.
#include "phiz/io/inspect.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "phiz/core/error.h"
#include "report.h"
#include "verbs.h"

namespace phiz {

void add_inspect(CLI::App& app) {
  struct Arguments {
    std::string file;
    Report report;
  };
  CLI::App* verb = app.add_subcommand("inspect", "Check a file and say what it holds");
  auto arguments = std::make_shared<Arguments>();
  verb->add_option("FILE", arguments->file, "Any file that Phiz reads: .phiz, mesh, recording, point cache, picture")
      ->required();
  add_report(*verb, arguments->report);
  verb->footer("Example:\n  phiz inspect take.phiz --json");
  verb->callback([arguments] {
    const nlohmann::json description = inspect(arguments->file);
    if (!arguments->report.wanted()) arguments->report.print(readable(description));
    arguments->report.write(description);
    for (const nlohmann::json& problem : description.value("problems", nlohmann::json::array()))
      reject(arguments->file, problem.get<std::string>());
  });
}

}  // namespace phiz
