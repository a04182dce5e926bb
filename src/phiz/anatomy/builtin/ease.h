// SPDX-License-Identifier: GPL-3.0-or-later
/// Smooth transitions for shaping.
#pragma once

#include <algorithm>

namespace phiz {

/// 0 below `from`, 1 above `to`, a cubic with level ends between.
inline double smoothstep(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace phiz
