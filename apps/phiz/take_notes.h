// SPDX-License-Identifier: GPL-3.0-or-later
/// What verbs that make takes say about their frames.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "phiz/face/play.h"

namespace phiz {

/// Tells which expressions of the performance the model does not have, and the reverse.
void announce_mismatch(const ExpressionMatch& match);

/// Collects the statistics of frames.
class TakeNotes {
 public:
  void note(const TakeFrame& frame, int number);
  /// frames, frames_not_converged, ms_median, ms_max, penetration_mm_max and, per frame, statistics.
  nlohmann::json report() const;
  /// "12 frames, 0 not converged, median 14.2 ms and at most 30.1 ms a frame, penetration at most 0.010 mm"
  std::string brief() const;

 private:
  nlohmann::json frames_ = nlohmann::json::array();
  std::vector<double> milliseconds_;
  int unconverged_ = 0;
  double penetration_ = 0;
};

}  // namespace phiz
