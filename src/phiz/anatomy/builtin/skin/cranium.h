// SPDX-License-Identifier: GPL-3.0-or-later
/// The simple body that cranium and neck are drawn on: horizontal sections from the cut of the neck to the crown. Mean
/// head, millimetres. Private to anatomy.
#pragma once

#include "phiz/geometry/mesh.h"

namespace phiz {

/// The point of the body's surface at height y (below the crown), `angle` degrees from the front round the left side.
Vector3d cranium_point(double angle, double y);
/// p carried to the body's surface: above the foot of the vault along the ray from its middle, below it along the
/// horizontal one.
Vector3d cranium_under(const Vector3d& p);
/// Half the width of the body at height y below the crown, at depth z.
double cranium_half_width(double y, double z);
/// Height of the vault over (x, z).
double vault_height(double x, double z);

}  // namespace phiz
