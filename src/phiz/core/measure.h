// SPDX-License-Identifier: GPL-3.0-or-later
/// What benchmarks measure with.
#pragma once

#include <chrono>
#include <vector>

namespace phiz {

/// Wall time since it was made.
class Stopwatch {
 public:
  double milliseconds() const { return std::chrono::duration<double, std::milli>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

/// The value below which the given share of the values lies, share in [0, 1]: 0.5 is the median, 1 the largest. 0 when
/// there are none.
double quantile(std::vector<double> values, double share);

/// The most memory that the process had resident so far, MiB.
double peak_memory_mib();

}  // namespace phiz
