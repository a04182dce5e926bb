// SPDX-License-Identifier: GPL-3.0-or-later
/// A rigid object beside a head: how verbs name it.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>

#include "phiz/face/simulate.h"

namespace CLI {
class App;
}

namespace phiz {

struct ObjectArguments {
  std::string file, path, at, frame = "world";
};

/// Adds --object, --object-path, --object-at and --object-frame.
void add_object_options(CLI::App& verb, ObjectArguments& arguments);

/// The object, if one was named: a closed surface, turned outward. Throws phiz::Error.
std::optional<SimulateObject> load_object(const ObjectArguments& arguments);

}  // namespace phiz
