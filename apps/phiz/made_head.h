// SPDX-License-Identifier: GPL-3.0-or-later
/// What the verbs of `template` that make a head say at their end.
#pragma once

#include <chrono>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "phiz/anatomy/head_template.h"
#include "report.h"

namespace phiz {

/// Writes `head` to `file`, then one line for people and the report for programs: counts, and the seconds since
/// `start`. `note` goes to the end of the line, `more` into the report.
void save_and_report(const std::string& file, const HeadTemplate& head, std::chrono::steady_clock::time_point start,
                     const Report& report, const std::string& note, const nlohmann::json& more);

}  // namespace phiz
