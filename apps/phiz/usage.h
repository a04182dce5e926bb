// SPDX-License-Identifier: GPL-3.0-or-later
/// What to tell the user of a command line that was not understood.
#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace phiz {

/// What is wrong, the nearest word that would be right, and where help is; in one line.
std::string usage_mistake(const CLI::App& app, const CLI::ParseError& event);

}  // namespace phiz
