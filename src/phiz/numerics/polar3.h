// SPDX-License-Identifier: GPL-3.0-or-later
/// Polar rotations and determinant-one projections of many 3x3 matrices at once, with the vector units of the machine
/// (chosen at run time). Kernels that keep their own data in registers include polar3-inl.h instead.
#pragma once

#include "phiz/geometry/mesh.h"

namespace phiz {

/// Row i is matrix i, its columns one after the other: entry (r, c) of matrix i is M(i, 3 c + r). Storage is by
/// columns, so that each entry is a contiguous array over the matrices.
using Matrices3 = Eigen::Matrix<double, Eigen::Dynamic, 9>;

/// R(i) = closest_rotation(A(i)), det R = 1 also for inverted and singular A. Where the closest rotation is unique the
/// result agrees with closest_rotation to 1e-12 / (s1 + s2) relative to the norm of A. In parallel; the same bits for
/// any number of threads. Throws phiz::Error(failure) when a matrix is not finite.
void closest_rotations(const Matrices3& A, Matrices3& R);

/// P(i) = closest_unimodular(A(i)): the closest matrix of determinant 1.
void closest_unimodulars(const Matrices3& A, Matrices3& P);

}  // namespace phiz
