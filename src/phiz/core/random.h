// SPDX-License-Identifier: GPL-3.0-or-later
/// Random numbers that are the same on every platform (the distributions of <random> are not).
#pragma once

#include <cstdint>

namespace phiz {

/// PCG32 (O'Neill 2014) with the distributions that Phiz needs.
class Random {
 public:
  explicit Random(std::uint64_t seed = 0, std::uint64_t stream = 0);
  std::uint32_t bits();
  double uniform();                          ///< in [0, 1)
  double uniform(double low, double high);   ///< in [low, high)
  double normal();                           ///< mean 0, standard deviation 1 (Box-Muller)
  std::uint32_t below(std::uint32_t limit);  ///< in [0, limit), unbiased; limit > 0

 private:
  std::uint64_t state_;
  std::uint64_t increment_;
};

}  // namespace phiz
