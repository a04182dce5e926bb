// SPDX-License-Identifier: GPL-3.0-or-later
/// Wind on a surface (phace.md section 7.1).
#pragma once

#include "phiz/geometry/mesh.h"

namespace phiz {

struct Air {
  Vector3d wind = Vector3d::Zero();  ///< metres/second
  double density = 1.2;              ///< kg/m^3
  double drag = 1;                   ///< coefficient, no unit
};

/// Force on every vertex, n x 3, newtons: a triangle of area A and unit normal n, moving with the mean velocity of its
/// corners, gets density drag A |n.u| (n.u) n / 2 with u = wind - velocity, a third at each corner. Nothing where the
/// wind blows along it; the same for either orientation. `triangles`: f x 3 rows of x; `velocity`: n x 3,
/// metres/second, empty for a surface at rest. Throws phiz::Error(bad_input) when sizes, indices or numbers make no
/// sense.
MatrixX3d wind_forces(const MatrixX3i& triangles, const MatrixX3d& x, const MatrixX3d& velocity, const Air& air);

}  // namespace phiz
