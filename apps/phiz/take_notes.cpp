// SPDX-License-Identifier: GPL-3.0-or-later
#include "take_notes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "phiz/core/progress.h"

namespace phiz {

namespace {

nlohmann::json as_json(int number, double time, const SolveStatistics& statistics) {
  return {{"frame", number},
          {"time_s", time},
          {"converged", statistics.converged},
          {"iterations", statistics.iterations},
          {"residual", statistics.residual},
          {"energy_j", statistics.energy},
          {"contacts", statistics.contacts},
          {"penetration_mm", 1e3 * statistics.penetration},
          {"volume_change", statistics.volume_change},
          {"last_step_mm", 1e3 * statistics.last_step},
          {"ms", statistics.milliseconds}};
}

/// Median and longest.
std::pair<double, double> spread(std::vector<double> values) {
  if (values.empty()) return {0, 0};
  std::sort(values.begin(), values.end());
  return {values[values.size() / 2], values.back()};
}

}  // namespace

void announce_mismatch(const ExpressionMatch& match) {
  if (!match.unmatched.empty())
    announce(fmt::format("the model does not have these expressions of the performance: {}",
                         fmt::join(match.unmatched, ", ")));
  if (!match.undriven.empty())
    announce(fmt::format("the performance does not drive these expressions of the model: {}",
                         fmt::join(match.undriven, ", ")));
}

void TakeNotes::note(const TakeFrame& frame, int number) {
  frames_.push_back(as_json(number, frame.time, frame.statistics));
  milliseconds_.push_back(frame.statistics.milliseconds);
  unconverged_ += frame.statistics.converged ? 0 : 1;
  penetration_ = std::max(penetration_, frame.statistics.penetration);
}

nlohmann::json TakeNotes::report() const {
  const auto [median, longest] = spread(milliseconds_);
  return {{"frames", frames_.size()}, {"frames_not_converged", unconverged_},     {"ms_median", median},
          {"ms_max", longest},        {"penetration_mm_max", 1e3 * penetration_}, {"statistics", frames_}};
}

std::string TakeNotes::brief() const {
  const auto [median, longest] = spread(milliseconds_);
  return fmt::format(
      "{} frames, {} not converged, median {:.1f} ms and at most {:.1f} ms a frame, penetration at most {:.3f} mm",
      frames_.size(), unconverged_, median, longest, 1e3 * penetration_);
}

}  // namespace phiz
