// SPDX-License-Identifier: GPL-3.0-or-later
/// Projections of a deformation gradient onto the sets of projective dynamics (Ichim 2017, section 5.2). Scalar and
/// robust: they take any finite matrix, inverted and singular ones too.
#pragma once

#include "phiz/geometry/mesh.h"

namespace phiz {

/// Signed singular value decomposition F = U diag(s) V^T with det U = det V = 1 and s0 >= s1 >= |s2|.
struct SignedSvd {
  Matrix3d U;
  Vector3d s;
  Matrix3d V;
};
SignedSvd signed_svd(const Matrix3d& F);

/// Rotation closest to F in the Frobenius norm; det = +1 also for inverted F.
Matrix3d nearest_rotation(const Matrix3d& F);

/// Matrix of determinant 1 closest to F in the Frobenius norm.
Matrix3d nearest_unimodular(const Matrix3d& F);

/// Singular values p (product 1) closest to the signed ones s, s0 >= s1 >= |s2|. They satisfy p_i - s_i = kappa / p_i.
Vector3d nearest_unimodular_values(const Vector3d& s);

}  // namespace phiz
