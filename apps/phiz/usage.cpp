// SPDX-License-Identifier: GPL-3.0-or-later
#include "usage.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <vector>

#include "phiz/core/nearest_words.h"

namespace phiz {

namespace {

/// "; did you mean 'x'?" for the candidate that is at most two edits away, or nothing.
std::string suggestion(const std::string& word, const std::vector<std::string>& candidates) {
  const std::vector<std::string> best = nearest_words(word, candidates, 1);
  if (best.empty() || edit_distance(word, best.front()) > 2) return {};
  return fmt::format("; did you mean '{}'?", best.front());
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
