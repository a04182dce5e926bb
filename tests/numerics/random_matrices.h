// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>

#include "phiz/core/random.h"
#include "phiz/geometry/mesh.h"

namespace phiz::test {

/// Independent normal entries.
inline Matrix3d random_matrix(Random& random) {
  Matrix3d A;
  for (int k = 0; k < 9; ++k) A.data()[k] = random.normal();
  return A;
}

inline Matrix3d random_rotation(Random& random) {
  Eigen::Quaterniond q(random.normal(), random.normal(), random.normal(), random.normal());
  return q.normalized().toRotationMatrix();
}

}  // namespace phiz::test
