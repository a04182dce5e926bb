// SPDX-License-Identifier: GPL-3.0-or-later
/// What any file that Phiz reads holds, after validation.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace phiz {

/// Reads the file completely, validates it and describes it. Members of every description: `file`, `bytes`, `kind`
/// ("mesh", "scene", "recording", "image", "point cache", "head", "model", "performance", "take") and `format`; a take
/// has `frames` (a number), `frames_planned`, `complete` and `statistics`; lengths are metres unless a name says
/// otherwise. `problems` lists what is wrong with a file that can be read all the same: a mesh that is not in metres.
/// Throws phiz::Error(bad_input) as the reader of the format does, or when no reader knows the extension.
nlohmann::json inspect(const std::string& path);

/// The description as indented lines for people.
std::string readable(const nlohmann::json& description);

}  // namespace phiz
