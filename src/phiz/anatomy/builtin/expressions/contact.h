// SPDX-License-Identifier: GPL-3.0-or-later
/// Two patches of the drawn skin that meet (upper and lower lip, upper and lower lid) and must not pass through one
/// another.
#pragma once

#include <string>
#include <vector>

#include "phiz/anatomy/head_template.h"

namespace phiz {

class PatchContact {
 public:
  /// The vertices of two regions of head.skin_regions; those that belong to both (the corners) stay as they are.
  /// `gap`: to leave between the patches, metres.
  PatchContact(const HeadTemplate& head, const std::string& upper, const std::string& lower, double gap);

  /// Moves points that lie up to 3 mm inside the other patch out of it, both patches half the way, and lets their
  /// surroundings follow. `displacement`: of head.skin, metres.
  void keep_apart(MatrixX3d& displacement) const;

 private:
  struct Patch {
    std::vector<int> vertices;   ///< rows of head.skin that are checked
    MatrixX3i triangles;         ///< over rows of head.skin
    std::vector<char> interior;  ///< per triangle: none of its vertices lies on the rim of both patches
  };
  Patch patch(const HeadTemplate& head, const VectorXi& own, const VectorXi& other) const;
  bool separate(const Patch& moving, const Patch& obstacle, const MatrixX3d& V, MatrixX3d& correction) const;

  MatrixX3d rest_;
  double gap_;
  Patch upper_, lower_;
  std::vector<std::pair<int, std::vector<int>>> surroundings_;  ///< vertices near the patches, and their neighbours
};

}  // namespace phiz
