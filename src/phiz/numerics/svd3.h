// SPDX-License-Identifier: GPL-3.0-or-later
/// 3x3 singular value decomposition and the projections built on it, one matrix at a time. They take any finite matrix,
/// singular and inverted ones too; polar3.h does many at once.
#pragma once

#include "phiz/geometry/mesh.h"

namespace phiz {

/// A = U diag(s) V^T with det U = det V = 1 and s0 >= s1 >= |s2|; s2 has the sign of det A.
struct Svd3 {
  Matrix3d U;
  Vector3d s;
  Matrix3d V;
};

/// One-sided Jacobi rotations (Hestenes 1958): small singular values keep their relative accuracy. A zero matrix gives
/// U = V = identity. Throws phiz::Error(failure) when A is not finite.
Svd3 svd3(const Matrix3d& A);

/// The rotation closest to A in the Frobenius norm, U V^T; det = +1 for any A. Where s1 + s2 = 0 it is not unique and
/// one of the closest is returned.
Matrix3d closest_rotation(const Matrix3d& A);

/// The matrix of determinant 1 closest to A in the Frobenius norm (Ichim et al. 2017, section 4, volume term).
Matrix3d closest_unimodular(const Matrix3d& A);

/// The positive numbers p of product 1 closest to s, for s0 >= s1 >= |s2|. They satisfy p_i (p_i - s_i) = mu for one
/// mu.
Vector3d closest_unimodular_values(const Vector3d& s);

}  // namespace phiz
