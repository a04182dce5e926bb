// SPDX-License-Identifier: GPL-3.0-or-later
/// Principal components.
#pragma once

#include "phiz/geometry/mesh.h"

namespace phiz {

struct PrincipalComponents {
  VectorXd mean;         ///< d, mean of the samples
  MatrixXd basis;        ///< d x k, orthonormal; the entry of largest size in each column is positive
  VectorXd deviation;    ///< k, standard deviation along each column (divisor: samples - 1), descending
  double explained = 1;  ///< share of the total variance that the basis holds
};

struct PcaOptions {
  double variance = 1.0;      ///< share of the variance to keep, in (0, 1]
  Eigen::Index most = 0;      ///< at most so many components; 0: no limit
  bool subtract_mean = true;  ///< otherwise `mean` is zero and deviations are about the origin
};

/// Components of samples in the columns of X (d x n, n usually much smaller than d), by a thin SVD.
/// Directions with less than 1e-7 of the largest deviation are left out. Throws phiz::Error(failure) when X is
/// empty or not finite.
PrincipalComponents principal_components(const MatrixXd& X, const PcaOptions& options = {});

/// Coordinates of x in the basis, in metres along each column.
VectorXd project(const PrincipalComponents& components, const VectorXd& x);
/// mean + basis * coordinates.
VectorXd reconstruct(const PrincipalComponents& components, const VectorXd& coordinates);

/// Thin singular value decomposition A = U diag(s) V^T, s descending, truncated at `tolerance` times s[0]; the entry of
/// largest size in each column of U is positive, so that the result does not depend on the machine.
struct ThinSvd {
  MatrixXd U;
  VectorXd s;
  MatrixXd V;
};
ThinSvd thin_svd(const MatrixXd& A, double tolerance = 1e-12);

}  // namespace phiz
