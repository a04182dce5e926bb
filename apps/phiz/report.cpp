// SPDX-License-Identifier: GPL-3.0-or-later
#include "report.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "phiz/core/version.h"
#include "phiz/io/output_file.h"

namespace phiz {

void Report::print(const std::string& text) const {
  if (json != "-") std::fputs(text.c_str(), stdout);
}

void Report::write(nlohmann::json report) const {
  if (!wanted()) return;
  report["phiz"] = version();
  const std::string text = report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  if (json == "-")
    std::fputs(text.c_str(), stdout);
  else
    write_bytes(json, text);
}

void add_report(CLI::App& verb, Report& report) {
  verb.add_option_function<std::string>(
          "--json", [&report](const std::string& target) { report.json = target.empty() ? "-" : target; },
          "Write a report as JSON to FILE, or to standard output (-, the default)")
      ->type_name("FILE|-")
      ->expected(0, 1);
}

}  // namespace phiz
