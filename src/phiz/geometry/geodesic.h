// SPDX-License-Identifier: GPL-3.0-or-later
/// Distances along a surface.
#pragma once

#include <span>

#include "phiz/geometry/mesh.h"

namespace phiz {

/// Length of the shortest path along edges from the nearest of `sources` (rows of V) to every vertex, metres; infinite
/// where there is none. An upper bound of the geodesic distance, a few per cent too long on even meshes.
VectorXd edge_distances(const MatrixX3d& V, const MatrixX3i& F, std::span<const int> sources);

}  // namespace phiz
