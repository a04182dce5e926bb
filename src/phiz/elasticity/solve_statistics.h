// SPDX-License-Identifier: GPL-3.0-or-later
/// What a solver says about its result; every solve returns one.
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace phiz {

struct SolveStatistics {
  bool converged = false;  ///< the stated tolerance was reached
  int iterations = 0;
  double residual = 0;       ///< relative force residual: |free force| / |applied elastic forces|
  double energy = 0;         ///< joules
  int contacts = 0;          ///< active constraint rows
  double penetration = 0;    ///< deepest remaining penetration, metres
  double volume_change = 0;  ///< (flesh volume - rest volume) / rest volume
  double last_step = 0;      ///< longest vertex movement of the last iteration, metres
  double milliseconds = 0;   ///< wall time of the solve
};

/// One iteration of a solver, for plots and for comparing engines: what held before its step, and the step.
struct TraceEntry {
  int iteration = 0;        ///< 1 for the first
  int round = 0;            ///< how often contact planes had been renewed before
  double energy = 0;        ///< joules
  double residual = 0;      ///< as in SolveStatistics
  int contacts = 0;         ///< constraint rows that push
  double violation = 0;     ///< deepest penetration of the planes in use, metres
  double step_length = 0;   ///< share of the computed step that was taken; 0: none was found
  double last_step = 0;     ///< longest vertex movement, metres
  double milliseconds = 0;  ///< wall time from the start of the solve to the end of the iteration
};

using Trace = std::vector<TraceEntry>;

/// One line for people: "converged in 6 iterations, residual 4.1e-04, 35 contacts, 14.2 ms".
std::string brief_report(const SolveStatistics& statistics);

/// Wall time from `start` to now.
double milliseconds_since(std::chrono::steady_clock::time_point start);

}  // namespace phiz
