// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/numerics/cholesky.h"

#include <gtest/gtest.h>

#include <cmath>

#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/core/random.h"

namespace phiz {
namespace {

/// Seven-point Laplacian of a cube of n^3 points plus `shift` on the diagonal.
SparseMatrixd grid_laplacian(int n, double shift) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto at = [n](int i, int j, int k) { return (k * n + j) * n + i; };
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        entries.emplace_back(at(i, j, k), at(i, j, k), shift);
        const int next[3][3] = {{i + 1, j, k}, {i, j + 1, k}, {i, j, k + 1}};
        for (const auto& q : next) {
          if (q[0] >= n || q[1] >= n || q[2] >= n) continue;
          const int a = at(i, j, k), b = at(q[0], q[1], q[2]);
          entries.emplace_back(a, a, 1);
          entries.emplace_back(b, b, 1);
          entries.emplace_back(a, b, -1);
          entries.emplace_back(b, a, -1);
        }
      }
  SparseMatrixd A(n * n * n, n * n * n);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

MatrixXd random_columns(Eigen::Index rows, Eigen::Index cols) {
  Random random(1);
  return MatrixXd::NullaryExpr(rows, cols, [&random] { return random.normal(); });
}

TEST(SparseCholesky, SolvesToRounding) {
  const SparseMatrixd A = grid_laplacian(12, 0.1);
  const MatrixXd B = random_columns(A.rows(), 3);
  const SparseCholesky factor(A);
  EXPECT_LE((A * factor.solve(B) - B).norm(), 1e-12 * B.norm());
  MatrixXd X = B;
  factor.solve_in_place(X);
  EXPECT_EQ(X, factor.solve(B));
}

TEST(SparseCholesky, RefactorsNewValuesWithTheSamePattern) {
  const SparseMatrixd A = grid_laplacian(8, 0.1), A2 = grid_laplacian(8, 3);
  const MatrixXd B = random_columns(A.rows(), 2);
  SparseCholesky factor(A);
  factor.refactor(A2);
  EXPECT_LE((A2 * factor.solve(B) - B).norm(), 1e-12 * B.norm());
  EXPECT_THROW(factor.refactor(grid_laplacian(7, 1)), Error);
}

TEST(SparseCholesky, RefusesIndefiniteSingularAndBrokenMatrices) {
  EXPECT_THROW(SparseCholesky(grid_laplacian(6, -0.5)), Error);
  SparseMatrixd broken = grid_laplacian(4, 1);
  broken.coeffRef(3, 3) = std::nan("");
  EXPECT_THROW(SparseCholesky{broken}, Error);
  EXPECT_THROW(SparseCholesky(SparseMatrixd(3, 4)), Error);
  EXPECT_THROW(SparseCholesky(SparseMatrixd(0, 0)), Error);
  SparseCholesky factor(grid_laplacian(4, 1));
  EXPECT_THROW(factor.solve(MatrixXd::Zero(3, 1)), Error);
  EXPECT_THROW(factor.refactor(grid_laplacian(4, -9)), Error);
  EXPECT_THROW(factor.solve(MatrixXd::Zero(64, 1)), Error);
  factor.refactor(grid_laplacian(4, 1));
  EXPECT_NO_THROW(factor.solve(MatrixXd::Zero(64, 1)));
}

TEST(SparseCholesky, SolvesFromSeveralThreadsGiveTheSameBits) {
  const SparseMatrixd A = grid_laplacian(10, 0.2);
  const MatrixXd B = random_columns(A.rows(), 3);
  const SparseCholesky factor(A);
  const MatrixXd expected = factor.solve(B);
  std::vector<MatrixXd> found(16);
  parallel_for(
      16, [&](std::ptrdiff_t i) { found[static_cast<std::size_t>(i)] = factor.solve(B); }, 1);
  for (const auto& X : found) EXPECT_EQ(X, expected);
}

}  // namespace
}  // namespace phiz
