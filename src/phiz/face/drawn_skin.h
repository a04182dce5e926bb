// SPDX-License-Identifier: GPL-3.0-or-later
/// The drawn skin of a head that follows its simulation skin.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "phiz/anatomy/head_template.h"

namespace phiz {

class DrawnSkin {
 public:
  explicit DrawnSkin(const HeadTemplate& head);

  /// Positions of the drawn skin for positions of the volume (both in the head frame, metres).
  MatrixX3d at(const MatrixX3d& volume) const;

 private:
  MatrixX3d rest_;            ///< of the drawn skin
  VectorXi simulated_;        ///< rows of the volume
  MatrixX3d simulated_rest_;  ///< positions of those
  std::vector<int> start_;    ///< of each drawn vertex in `source_` and `weight_`
  std::vector<int> source_;   ///< places in `simulated_`
  std::vector<float> weight_;
};

}  // namespace phiz
