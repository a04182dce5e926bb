// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/core/measure.h"

#include <sys/resource.h>

#include <algorithm>
#include <cstddef>

namespace phiz {

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

double peak_memory_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

}  // namespace phiz
