// SPDX-License-Identifier: GPL-3.0-or-later
/// What the verbs of `template` that make a head have in common.
#pragma once

#include <chrono>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "phiz/anatomy/builtin/builtin_head.h"
#include "phiz/anatomy/head_template.h"
#include "report.h"

namespace phiz {

/// The built-in head, with a progress bar.
HeadTemplate make_builtin_head(BuiltinOptions options);

/// Writes `head` to `file`, then one line for people and the report for programs: counts, and the seconds since
/// `start`. `note` goes to the end of the line, `more` into the report.
void save_and_report(const std::string& file, const HeadTemplate& head, std::chrono::steady_clock::time_point start,
                     const Report& report, const std::string& note, const nlohmann::json& more);

}  // namespace phiz
