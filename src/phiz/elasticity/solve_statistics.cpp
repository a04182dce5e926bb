// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/solve_statistics.h"

#include <cstdio>

namespace phiz {

std::string brief_report(const SolveStatistics& statistics) {
  char text[200];
  std::snprintf(text, sizeof text, "%s in %d iteration%s, residual %.1e, %d contact%s, %.1f ms",
                statistics.converged ? "converged" : "stopped", statistics.iterations,
                statistics.iterations == 1 ? "" : "s", statistics.residual, statistics.contacts,
                statistics.contacts == 1 ? "" : "s", statistics.milliseconds);
  return text;
}

double milliseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace phiz
