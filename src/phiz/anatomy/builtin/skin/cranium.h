// SPDX-License-Identifier: GPL-3.0-or-later
/// The simple body that cranium and neck are drawn on: horizontal sections from the cut of the neck to the crown. Mean
/// head, millimetres. Private to anatomy.
#pragma once

#include "phiz/geometry/mesh.h"

namespace phiz {

/// The point of the body's surface at height y (below the crown), `angle` degrees from the front round the left side.
Vector3d cranium_point(double angle, double y);
/// The point of the surface straight above or below, or before or behind p: in the direction of p from the middle of
/// the head.
Vector3d cranium_under(const Vector3d& p);
/// Half the width of the body at height y below the crown, at depth z.
double cranium_half_width(double y, double z);
/// Height of the vault over (x, z).
double vault_height(double x, double z);

}  // namespace phiz
