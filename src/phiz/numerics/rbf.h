// SPDX-License-Identifier: GPL-3.0-or-later
/// Scattered interpolation with radial functions (Carr et al. 2001; Duchon 1977).
#pragma once

#include "phiz/geometry/mesh.h"

namespace phiz {

enum class RbfKernel {
  biharmonic,   ///< r: smooth, least bending in space
  triharmonic,  ///< r^3: smoother still
};

/// s(x) = sum_i w_i phi(|x - c_i|) + polynomial of degree 1, with any number of values per point. Interpolates (or,
/// with `smoothing`, approximates) the values at the centres; reproduces affine maps exactly.
class Rbf {
 public:
  /// centres: n x 3, distinct, n >= 4 and not all in one plane; values: n x k. smoothing >= 0, in units of the kernel.
  /// Throws phiz::Error(failure) naming the reason when the system has no unique solution.
  Rbf(const MatrixX3d& centres, const MatrixXd& values, RbfKernel kernel = RbfKernel::biharmonic, double smoothing = 0);

  VectorXd operator()(const Vector3d& x) const;
  /// One row per row of X; in parallel.
  MatrixXd evaluate(const MatrixX3d& X) const;
  /// k x 3 derivative at x.
  MatrixXd jacobian(const Vector3d& x) const;

 private:
  MatrixX3d centres_;
  Vector3d origin_;
  double scale_;  // the system is solved in coordinates of unit size
  RbfKernel kernel_;
  MatrixXd weights_;     // n x k
  MatrixXd polynomial_;  // 4 x k: constant, x, y, z
};

}  // namespace phiz
