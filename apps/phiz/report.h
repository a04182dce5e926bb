// SPDX-License-Identifier: GPL-3.0-or-later
/// What every verb says at its end: a few lines for people, or with --json a report for programs.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace CLI {
class App;
}

namespace phiz {

/// Where the JSON report of a verb goes: a file, "-" for standard output, or empty for none.
struct Report {
  std::string json;

  bool wanted() const { return !json.empty(); }
  /// Text for people goes to standard output, unless the JSON does.
  void print(const std::string& text) const;
  /// Writes `report`, with the version of Phiz, where it was asked for.
  void write(nlohmann::json report) const;
};

/// Adds --json [FILE|-] to a verb.
void add_report(CLI::App& verb, Report& report);

}  // namespace phiz
