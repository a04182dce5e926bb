// SPDX-License-Identifier: GPL-3.0-or-later
/// Deformation gradients of surface triangles (deformation transfer; Ichim 2017, section 5.3.2).
#pragma once

#include <vector>

#include "phiz/geometry/mesh.h"

namespace phiz {

/// Gradient of each triangle from `rest` to `deformed`: F = [e1' e2' n'/sqrt|n'|] [e1 e2 n/sqrt|n|]^-1 with n = e1 x
/// e2, so that the third axis scales with the square root of the area. A degenerate triangle has the identity.
std::vector<Matrix3d> surface_gradients(const MatrixX3d& rest, const MatrixX3d& deformed, const MatrixX3i& triangles);

}  // namespace phiz
