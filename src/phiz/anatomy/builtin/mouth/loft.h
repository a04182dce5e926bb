// SPDX-License-Identifier: GPL-3.0-or-later
/// Closed surfaces through a stack of closed rings.
#pragma once

#include <span>
#include <vector>

#include "phiz/geometry/mesh.h"

namespace phiz {

/// The closed outward surface through `rings` (at least two, each with the same number of points, at least three), both
/// ends closed by a fan about the mean of the end ring. Vertices: the rings in order, then the two middles. Texture
/// coordinates: u round the ring, v along the stack.
TriangleMesh loft(std::span<const MatrixX3d> rings);

/// The vertices of loft(rings), in the same order.
MatrixX3d loft_vertices(std::span<const MatrixX3d> rings);

/// The mirror image in the plane x = 0, still outward.
TriangleMesh mirrored(const TriangleMesh& mesh);

}  // namespace phiz
