// SPDX-License-Identifier: GPL-3.0-or-later
/// Evens out displacements of the drawn skin where they fold it over or push it through itself.
#pragma once

#include <vector>

#include "phiz/anatomy/head_template.h"

namespace phiz {

class SkinMender {
 public:
  /// Keeps a reference to head.skin.
  explicit SkinMender(const HeadTemplate& head);

  /// Smooths the displacement round triangles that it folds over, or nearly so when they are not at rest, until there
  /// are none or 40 rounds are over; farther and farther round those that resist. Vertices with `kept` stay as they
  /// are.
  void mend_folds(const std::vector<char>& kept, MatrixX3d& displacement) const;

  /// The same round triangles of the mouth (lips and oral cavity) that pass through one another; keeps the best of 12
  /// rounds.
  void mend_crossings_in_the_mouth(MatrixX3d& displacement) const;

 private:
  const TriangleMesh& skin_;
  VectorXd at_rest_;                          ///< uprightness of the triangles at rest
  std::vector<std::vector<int>> neighbours_;  ///< of the vertices
  std::vector<int> mouth_;                    ///< triangles
};

}  // namespace phiz
