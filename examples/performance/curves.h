// SPDX-License-Identifier: GPL-3.0-or-later
/// Smooth curves over time that gestures are built from.
#pragma once

#include <utility>
#include <vector>

namespace phiz::authoring {

/// Minimum-jerk step (Flash and Hogan 1985): 0 for u <= 0, 1 for u >= 1, with zero speed and acceleration at both ends.
double minimum_jerk(double u);

/// A gesture that rises to 1, relaxes a little while it is held (few muscles hold still), and falls back to 0. Seconds.
struct Gesture {
  double start = 0, rise = 0.25, hold = 0.3, fall = 0.35;
  double relaxation = 0.12;  ///< what is lost by the end of the hold
  double at(double time) const;
};

/// A value that rests at each key and moves between keys with minimum jerk. Keys: (seconds, value), ascending.
class Track {
 public:
  /// One stop: the value is reached at `arrive` after a movement that takes `movement` seconds.
  struct Stop {
    double arrive, movement, value;
  };
  explicit Track(double initial, std::vector<Stop> stops) : initial_(initial), stops_(std::move(stops)) {}
  double at(double time) const;

 private:
  double initial_;
  std::vector<Stop> stops_;
};

}  // namespace phiz::authoring
