// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/skin_maps.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "phiz/core/parallel.h"
#include "phiz/geometry/operators.h"
#include "phiz/geometry/spatial_query.h"
#include "phiz/numerics/cholesky.h"

namespace phiz {

SparseMatrixd sample_skin(const TriangleMesh& drawn, const MatrixX3d& simulated) {
  return interpolation_matrix(SurfaceQuery(drawn).closest_points(simulated), drawn.F, drawn.V.rows());
}

SparseMatrixd smooth_interpolation(const TriangleMesh& drawn, const SparseMatrixd& sampling) {
  constexpr double least_weight = 0.003, firmness = 1e3, tension = 1 / (0.0005 * 0.0005);
  constexpr Eigen::Index block = 96;
  const Eigen::Index n = drawn.V.rows(), s = sampling.rows();
  const SparseMatrixd L = cotangent_laplacian(drawn.V, drawn.F);
  const VectorXd mass = lumped_triangle_mass(drawn.V, drawn.F).cwiseMax(1e-12);
  const SparseMatrixd bending = L * mass.cwiseInverse().asDiagonal() * L;
  const double scale = firmness * bending.diagonal().mean();
  const SparseMatrixd samples = sampling.transpose();
  const SparseCholesky system(SparseMatrixd(bending + tension * L + scale * SparseMatrixd(samples * sampling)));

  const Eigen::Index blocks = (s + block - 1) / block;
  std::vector<std::vector<Eigen::Triplet<double>>> found(static_cast<std::size_t>(blocks));
  parallel_for(
      blocks,
      [&](std::ptrdiff_t b) {
        const Eigen::Index first = b * block, count = std::min(block, s - first);
        MatrixXd X = MatrixXd::Zero(n, count);
        for (Eigen::Index j = 0; j < count; ++j)
          for (SparseMatrixd::InnerIterator it(sampling, first + j); it; ++it) X(it.col(), j) = scale * it.value();
        system.solve_in_place(X);
        for (Eigen::Index j = 0; j < count; ++j)
          for (Eigen::Index i = 0; i < n; ++i)
            if (std::abs(X(i, j)) >= least_weight)
              found[static_cast<std::size_t>(b)].emplace_back(static_cast<int>(i), static_cast<int>(first + j),
                                                              X(i, j));
      },
      1);
  std::vector<Eigen::Triplet<double>> all;
  for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
  SparseMatrixd W(n, s);
  W.setFromTriplets(all.begin(), all.end());
  for (Eigen::Index i = 0; i < n; ++i) {
    double sum = 0;
    for (SparseMatrixd::InnerIterator it(W, i); it; ++it) sum += it.value();
    for (SparseMatrixd::InnerIterator it(W, i); it; ++it) it.valueRef() /= sum;
  }
  return W;
}

}  // namespace phiz
