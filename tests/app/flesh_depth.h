// SPDX-License-Identifier: GPL-3.0-or-later
/// Penetration by geometry alone, which shares nothing with the contact code.
#pragma once

#include <vector>

#include "phiz/anatomy/head_template.h"

namespace phiz::testing {

/// How deep lips, cheeks and lids lie in flesh that is not their own.
class FleshDepth {
 public:
  explicit FleshDepth(const HeadTemplate& head);

  /// The deepest of their vertices for positions V of the volume: inside of a soft tet that has no corner in common
  /// with its own tets, by the distance from the nearest skin around. Metres.
  double deepest(const MatrixX3d& V) const;

 private:
  MatrixX4i flesh_;
  MatrixX3i skin_;
  std::vector<int> vertices_;
  std::vector<std::vector<int>> surroundings_;  ///< of each of those: the sorted corners of its tets
};

}  // namespace phiz::testing
