// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/numerics/pca.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "phiz/core/error.h"

namespace phiz {

namespace {

/// The entry of largest magnitude of each left vector is made positive.
void fix_signs(ThinSvd& svd) {
  for (Eigen::Index k = 0; k < svd.s.size(); ++k) {
    Eigen::Index largest = 0;
    svd.U.col(k).cwiseAbs().maxCoeff(&largest);
    if (svd.U(largest, k) < 0) {
      svd.U.col(k) *= -1;
      svd.V.col(k) *= -1;
    }
  }
}

}  // namespace

ThinSvd thin_svd(const MatrixXd& A, double tolerance) {
  if (A.size() == 0) fail("a matrix to be decomposed is empty");
  if (!A.allFinite()) fail("a matrix to be decomposed is not finite");
  if (A.rows() < A.cols()) {
    ThinSvd flipped = thin_svd(A.transpose(), tolerance);
    ThinSvd out{flipped.V, flipped.s, flipped.U};
    fix_signs(out);
    return out;
  }
  // Tall: QR first, then the small triangle.
  const Eigen::HouseholderQR<MatrixXd> qr(A);
  const MatrixXd R = qr.matrixQR().topRows(A.cols()).triangularView<Eigen::Upper>();
  const Eigen::JacobiSVD<MatrixXd, Eigen::NoQRPreconditioner> svd(R, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const VectorXd& s = svd.singularValues();
  Eigen::Index rank = 0;
  while (rank < s.size() && s[rank] > tolerance * s[0]) ++rank;
  MatrixXd U = MatrixXd::Zero(A.rows(), rank);
  U.topRows(A.cols()) = svd.matrixU().leftCols(rank);
  U.applyOnTheLeft(qr.householderQ());
  ThinSvd out{std::move(U), s.head(rank), svd.matrixV().leftCols(rank)};
  fix_signs(out);
  return out;
}

PrincipalComponents principal_components(const MatrixXd& X, const PcaOptions& options) {
  if (X.size() == 0) fail("principal components need at least one sample");
  if (!X.allFinite()) fail("the samples of a principal component analysis are not finite");
  if (!(options.variance > 0 && options.variance <= 1) || options.most < 0)
    throw Error(ErrorKind::usage, "the share of variance must lie in (0, 1] and the number of components not below 0");
  PrincipalComponents out;
  out.mean = options.subtract_mean ? VectorXd(X.rowwise().mean()) : VectorXd::Zero(X.rows());
  const MatrixXd centred = X.colwise() - out.mean;
  const ThinSvd svd = thin_svd(centred, 1e-7);
  const double divisor = std::max<double>(1, static_cast<double>(X.cols()) - (options.subtract_mean ? 1 : 0));
  const double total = centred.squaredNorm();
  Eigen::Index kept = 0;
  double sum = 0;
  const Eigen::Index limit = options.most > 0 ? std::min(options.most, svd.s.size()) : svd.s.size();
  while (kept < limit && sum < options.variance * total) {
    sum += svd.s[kept] * svd.s[kept];
    ++kept;
  }
  out.basis = svd.U.leftCols(kept);
  out.deviation = svd.s.head(kept) / std::sqrt(divisor);
  out.explained = total > 0 ? std::min(1.0, sum / total) : 1.0;
  return out;
}

VectorXd project(const PrincipalComponents& components, const VectorXd& x) {
  return components.basis.transpose() * (x - components.mean);
}

VectorXd reconstruct(const PrincipalComponents& components, const VectorXd& coordinates) {
  return components.mean + components.basis * coordinates;
}

}  // namespace phiz
