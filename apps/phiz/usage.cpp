// SPDX-License-Identifier: GPL-3.0-or-later
#include "usage.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <numeric>
#include <vector>

namespace phiz {

namespace {

/// Letters to insert, delete, replace or swap with a neighbour that lead from a to b.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  std::iota(d[0].begin(), d[0].end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

/// "; did you mean 'x'?" for the candidate that is at most two edits away, or nothing.
std::string suggestion(const std::string& word, const std::vector<std::string>& candidates) {
  const auto distance = [&word](const std::string& candidate) { return edit_distance(word, candidate); };
  const auto best = std::min_element(candidates.begin(), candidates.end(),
                                     [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
  if (best == candidates.end() || distance(*best) > 2) return {};
  return fmt::format("; did you mean '{}'?", *best);
}

std::vector<std::string> verbs_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* verb : app.get_subcommands({})) names.push_back(verb->get_name());
  return names;
}

/// Long options of a verb, and those that it has in common with all verbs.
std::vector<std::string> options_of(const CLI::App& verb) {
  std::vector<std::string> names;
  for (const CLI::App* app = &verb; app != nullptr; app = app->get_parent())
    for (const CLI::Option* option : app->get_options())
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

}  // namespace

std::string usage_mistake(const CLI::App& app, const CLI::ParseError& event) {
  const CLI::App* verb = &app;
  std::string name = app.get_name();
  while (!verb->get_subcommands().empty()) {
    verb = verb->get_subcommands().front();
    name += " " + verb->get_name();
  }
  const std::string help = fmt::format("; see {} --help", name);
  const std::vector<std::string> verbs = verbs_of(*verb);
  const std::vector<std::string> left = app.remaining(true);  // words that were not understood

  const auto option = std::find_if(left.begin(), left.end(), [](const auto& word) { return word.starts_with("-"); });
  if (option != left.end() && (verbs.empty() || option == left.begin())) {
    const std::string bare = option->substr(0, option->find('='));
    return fmt::format("{} has no option '{}'{}{}", name, bare, suggestion(bare, options_of(*verb)), help);
  }
  if (!verbs.empty() && !left.empty())
    return fmt::format("there is no '{} {}'{}; known: {}{}", name, left.front(), suggestion(left.front(), verbs),
                       fmt::join(verbs, ", "), help);
  if (!left.empty()) return fmt::format("'{}' is one argument too many for {}{}", left.front(), name, help);
  if (!verbs.empty() && event.get_exit_code() == static_cast<int>(CLI::ExitCodes::RequiredError))
    return fmt::format("{} needs one of these words: {}{}", name, fmt::join(verbs, ", "), help);
  return event.what() + help;
}

}  // namespace phiz
