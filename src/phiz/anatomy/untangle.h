// SPDX-License-Identifier: GPL-3.0-or-later
/// Removal of small self-intersections of a surface.
#pragma once

#include <string>

#include "phiz/geometry/mesh.h"

namespace phiz {

/// Smooths the triangles that cross others, with a ring of neighbours more every five passes, until none does. Returns
/// the number of smoothing passes made; throws phiz::Error(failure) naming `name` when `passes` do not suffice.
int untangle(TriangleMesh& mesh, const std::string& name, int passes);

}  // namespace phiz
