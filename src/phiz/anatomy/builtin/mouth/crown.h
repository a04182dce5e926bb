// SPDX-License-Identifier: GPL-3.0-or-later
/// One tooth as a closed surface.
#pragma once

#include "phiz/anatomy/builtin/mouth/dentition.h"
#include "phiz/geometry/mesh.h"

namespace phiz {

/// The crown with a short root, `width` x `thickness` x `height` metres. x: along the arch, distal positive; y: from
/// the neck (0) to the edge (height); z: 0 on the labial outline of the arch, negative inwards.
TriangleMesh make_crown(const ToothForm& form, double width, double thickness, double height);

}  // namespace phiz
