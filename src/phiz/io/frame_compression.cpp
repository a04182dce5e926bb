// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/io/frame_compression.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "phiz/core/parallel.h"

namespace phiz {

namespace {

/// Displacements of all frames: one column per frame, coordinates of a vertex one after the other.
Eigen::MatrixXf displacements(const MatrixX3d& rest, const std::vector<const MatrixX3f*>& frames) {
  Eigen::MatrixXf D(3 * rest.rows(), static_cast<Eigen::Index>(frames.size()));
  for (Eigen::Index f = 0; f < D.cols(); ++f) {
    const MatrixX3f& frame = *frames[static_cast<std::size_t>(f)];
    for (Eigen::Index i = 0; i < rest.rows(); ++i) {
      for (int k = 0; k < 3; ++k) D(3 * i + k, f) = static_cast<float>(frame(i, k) - rest(i, k));
    }
  }
  return D;
}

struct Errors {
  double max_squared = 0;
  double sum_squared = 0;
};

Errors measure(const Eigen::MatrixXf& residual) {
  const Eigen::Index frames = residual.cols();
  std::vector<Errors> each(static_cast<std::size_t>(frames));
  parallel_for(
      frames,
      [&](std::ptrdiff_t f) {
        Errors& e = each[static_cast<std::size_t>(f)];
        for (Eigen::Index i = 0; i + 2 < residual.rows(); i += 3) {
          const double d = residual.col(f).segment<3>(i).cast<double>().squaredNorm();
          e.max_squared = std::max(e.max_squared, d);
          e.sum_squared += d;
        }
      },
      1);
  Errors all;
  for (const Errors& e : each) {
    all.max_squared = std::max(all.max_squared, e.max_squared);
    all.sum_squared += e.sum_squared;
  }
  return all;
}

}  // namespace

CompressedFrames compress_frames(const MatrixX3d& rest, const std::vector<const MatrixX3f*>& frames, double tolerance) {
  CompressedFrames result;
  Eigen::MatrixXf residual = displacements(rest, frames);
  const Eigen::Index count = residual.cols();
  if (residual.size() == 0) return result;
  // Eigenvectors of D^T D: the principal weights per frame, least important first.
  Eigen::MatrixXd gram(count, count);
  parallel_for(
      count,
      [&](std::ptrdiff_t a) {
        const Eigen::VectorXd column = residual.col(a).cast<double>();
        for (Eigen::Index b = 0; b <= a; ++b) {
          gram(a, b) = gram(b, a) = column.dot(residual.col(b).cast<double>());
        }
      },
      1);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(gram);
  result.weights.resize(count, 0);
  Errors errors = measure(residual);
  const double limit = tolerance * tolerance;
  for (Eigen::Index k = count - 1; k >= 0 && errors.max_squared > limit; --k) {
    const Eigen::VectorXd v = solver.eigenvectors().col(k);
    Eigen::Index peak = 0;
    if (!(v.cwiseAbs().maxCoeff(&peak) > 0)) continue;
    const double largest = v[peak];
    // D v is the shape for weights v; scaled so that the largest weight is +1. The residual is deflated with what is
    // stored, so that later shapes repair the rounding of earlier ones.
    const Eigen::VectorXf weights = (v / largest).cast<float>();
    const Eigen::VectorXf shape = residual * v.cast<float>() * static_cast<float>(largest);
    parallel_for(
        count, [&](std::ptrdiff_t f) { residual.col(f) -= shape * weights[f]; }, 4);
    result.shapes.emplace_back(Eigen::Map<const MatrixX3f>(shape.data(), rest.rows(), 3));
    result.weights.conservativeResize(count, result.weights.cols() + 1);
    result.weights.col(result.weights.cols() - 1) = weights;
    errors = measure(residual);
  }
  const double points = static_cast<double>(std::max<Eigen::Index>(rest.rows() * count, 1));
  result.max_error = std::sqrt(errors.max_squared);
  result.rms_error = std::sqrt(errors.sum_squared / points);
  return result;
}

}  // namespace phiz
