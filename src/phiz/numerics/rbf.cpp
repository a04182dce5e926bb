// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/numerics/rbf.h"

#include <spdlog/fmt/fmt.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "phiz/core/error.h"
#include "phiz/core/parallel.h"

namespace phiz {

namespace {

double phi(RbfKernel kernel, double r) {
  return kernel == RbfKernel::biharmonic ? r : r * r * r;
}

/// phi'(r) / r
double slope_over_radius(RbfKernel kernel, double r) {
  if (kernel == RbfKernel::triharmonic) return 3 * r;
  return r > 0 ? 1 / r : 0;
}

void require_distinct(const MatrixX3d& C) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(C.rows()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  const auto before = [&C](Eigen::Index a, Eigen::Index b) {
    for (int k = 0; k < 3; ++k)
      if (C(a, k) != C(b, k)) return C(a, k) < C(b, k);
    return a < b;
  };
  std::sort(order.begin(), order.end(), before);
  for (std::size_t i = 1; i < order.size(); ++i)
    if (C.row(order[i - 1]) == C.row(order[i]))
      fail(fmt::format("radial interpolation: centres {} and {} coincide", order[i - 1], order[i]),
           "remove one of them");
}

}  // namespace

Rbf::Rbf(const MatrixX3d& centres, const MatrixXd& values, RbfKernel kernel, double smoothing) : kernel_(kernel) {
  const Eigen::Index n = centres.rows();
  if (n < 4) fail("radial interpolation needs at least 4 centres");
  if (values.rows() != n) fail(fmt::format("radial interpolation: {} values for {} centres", values.rows(), n));
  if (!centres.allFinite() || !values.allFinite() || !(smoothing >= 0))
    fail("radial interpolation: a centre, a value or the smoothing is not finite");
  require_distinct(centres);
  origin_ = centres.colwise().mean();
  centres_ = centres.rowwise() - origin_.transpose();
  scale_ = 1 / centres_.rowwise().norm().maxCoeff();
  centres_ *= scale_;

  MatrixXd P(n, 4);
  P << VectorXd::Ones(n), centres_;
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(P);
  const VectorXd pivots = qr.matrixR().diagonal().head(4).cwiseAbs();
  if (pivots.minCoeff() < 1e-9 * pivots.maxCoeff())
    fail("radial interpolation: all centres lie in one plane", "add centres off the plane");
  // Signs that make the kernel conditionally positive definite (order 2: linear polynomials).
  const double sign = kernel == RbfKernel::biharmonic ? -1 : 1;
  MatrixXd system = MatrixXd::Zero(n + 4, n + 4);
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = 0; i < n; ++i) system(i, j) = phi(kernel, (centres_.row(i) - centres_.row(j)).norm());
  system.topLeftCorner(n, n).diagonal().array() += sign * smoothing * phi(kernel, scale_);
  system.topRightCorner(n, 4) = P;
  system.bottomLeftCorner(4, n) = P.transpose();
  MatrixXd right = MatrixXd::Zero(n + 4, values.cols());
  right.topRows(n) = values;
  const MatrixXd solution = system.partialPivLu().solve(right);
  if (!solution.allFinite()) fail("radial interpolation: the system is singular", "look for nearly coinciding centres");
  weights_ = solution.topRows(n);
  polynomial_ = solution.bottomRows(4);
}

VectorXd Rbf::operator()(const Vector3d& x) const {
  const Vector3d y = scale_ * (x - origin_);
  VectorXd value = polynomial_.row(0) + y.transpose() * polynomial_.bottomRows(3);
  for (Eigen::Index i = 0; i < centres_.rows(); ++i)
    value += phi(kernel_, (y.transpose() - centres_.row(i)).norm()) * weights_.row(i).transpose();
  return value;
}

MatrixXd Rbf::evaluate(const MatrixX3d& X) const {
  MatrixXd values(X.rows(), weights_.cols());
  parallel_for(
      X.rows(), [&](Eigen::Index i) { values.row(i) = (*this)(X.row(i)); }, 64);
  return values;
}

MatrixXd Rbf::jacobian(const Vector3d& x) const {
  const Vector3d y = scale_ * (x - origin_);
  MatrixXd J = polynomial_.bottomRows(3).transpose();
  for (Eigen::Index i = 0; i < centres_.rows(); ++i) {
    const Vector3d offset = y - centres_.row(i).transpose();
    J += slope_over_radius(kernel_, offset.norm()) * weights_.row(i).transpose() * offset.transpose();
  }
  return scale_ * J;
}

}  // namespace phiz
