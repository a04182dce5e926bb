// SPDX-License-Identifier: GPL-3.0-or-later
/// What a solver says about its result; every solve returns one.
#pragma once

#include <string>

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

/// One line for people: "converged in 6 iterations, residual 4.1e-04, 35 contacts, 14.2 ms".
std::string brief_report(const SolveStatistics& statistics);

}  // namespace phiz
