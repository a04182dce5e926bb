// SPDX-License-Identifier: GPL-3.0-or-later
/// Descriptions of the nouns in .phiz files. Private to inspect.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "phiz/face/performance.h"

namespace phiz {

nlohmann::json describe(const Performance& performance);

/// Whatever the .phiz file holds.
nlohmann::json describe_container(const std::string& path);

}  // namespace phiz
