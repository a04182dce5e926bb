// SPDX-License-Identifier: GPL-3.0-or-later
/// Penetration by geometry alone, which shares nothing with the contact code.
#pragma once

#include <vector>

#include "phiz/anatomy/head_template.h"

namespace phiz::testing {

/// What flesh a vertex may be in: its own tets only, or those that touch them too, so that a tet at the skin that is
/// turned over in a stretched corner of the mouth counts nothing.
enum class OwnFlesh { tets, surroundings };

/// How deep lips, cheeks and lids lie in flesh that is not their own.
class FleshDepth {
 public:
  FleshDepth(const HeadTemplate& head, OwnFlesh own);

  /// The deepest of their vertices for positions V of the volume: inside of a soft tet that is not its own, by the
  /// distance from the nearest skin around. Metres.
  double deepest(const MatrixX3d& V) const;

 private:
  MatrixX4i flesh_;
  MatrixX3i skin_;
  std::vector<int> vertices_;
  std::vector<std::vector<int>>
      surroundings_;  ///< of each of those: sorted vertices; a tet with one of them is its own
};

}  // namespace phiz::testing
