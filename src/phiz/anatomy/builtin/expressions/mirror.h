// SPDX-License-Identifier: GPL-3.0-or-later
/// Reflection of displacements in the plane x = 0.
#pragma once

#include "phiz/geometry/mesh.h"

namespace phiz {

/// The partner of every vertex under reflection in x = 0: the nearest vertex to the reflected one.
VectorXi mirror_partners(const MatrixX3d& V);

/// The reflected displacements D (one row per vertex).
MatrixX3d reflected(const MatrixX3d& D, const VectorXi& partner);

}  // namespace phiz
