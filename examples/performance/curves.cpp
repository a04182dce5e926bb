// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves.h"

#include <algorithm>

namespace phiz::authoring {

double minimum_jerk(double u) {
  u = std::clamp(u, 0.0, 1.0);
  return u * u * u * (10 + u * (-15 + 6 * u));
}

double Gesture::at(double time) const {
  const double up = minimum_jerk((time - start) / rise) *
                    (1 - relaxation * minimum_jerk((time - start - 0.7 * rise) / (rise + hold)));
  const double down = minimum_jerk((time - start - rise - hold) / fall);
  return up * (1 - down);
}

double Track::at(double time) const {
  double value = initial_;
  double previous = initial_;
  for (const Stop& stop : stops_) {
    value += (stop.value - previous) * minimum_jerk((time - stop.arrive + stop.movement) / stop.movement);
    previous = stop.value;
  }
  return value;
}

}  // namespace phiz::authoring
