// SPDX-License-Identifier: GPL-3.0-or-later
/// Maps between the drawn skin and a simulation skin that lies on it.
#pragma once

#include "phiz/geometry/mesh.h"

namespace phiz {

/// HeadTemplate::skin_sampling: simulation vertices (s x 3, on or very near the drawn skin) as points of its triangles.
SparseMatrixd sample_skin(const TriangleMesh& drawn, const MatrixX3d& simulated);

/// HeadTemplate::skin_interpolation for a given sampling S (s x n): the displacement of the drawn skin that bends least
/// (integral of the squared Laplacian, Botsch and Kobbelt 2004) while its samples follow the simulation, under a
/// tension (integral of the squared gradient over 0.25 mm^2) that keeps it from overshooting into folds where the skin is
/// gathered. Weights below 0.003 are dropped; rows sum to 1.
SparseMatrixd smooth_interpolation(const TriangleMesh& drawn, const SparseMatrixd& sampling);

}  // namespace phiz
