// SPDX-License-Identifier: GPL-3.0-or-later
/// Removal of small self-intersections of a surface.
#pragma once

#include "phiz/geometry/mesh.h"

namespace phiz {

/// Smooths the triangles that cross others, with a ring of neighbours more every five passes, until none does. Returns
/// whether that was reached within `passes`.
bool untangle(TriangleMesh& mesh, int passes);

}  // namespace phiz
