// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/numerics/block_cholesky.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

#include "phiz/core/parallel.h"
#include "phiz/core/random.h"

namespace phiz {
namespace {

/// Tets of a grid of n x n x depth cells, six each.
MatrixX4i grid_tets(int n, int depth) {
  constexpr int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {1, 0, 2}, {2, 1, 0}};
  MatrixX4i tets(6 * n * n * depth, 4);
  const auto id = [n](const int* at) { return (at[2] * (n + 1) + at[1]) * (n + 1) + at[0]; };
  Eigen::Index t = 0;
  for (int k = 0; k < depth; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        for (const auto& order : orders) {
          int at[3] = {i, j, k};
          tets(t, 0) = id(at);
          for (int s = 0; s < 3; ++s) {
            ++at[order[s]];
            tets(t, s + 1) = id(at);
          }
          ++t;
        }
  return tets;
}

struct System {
  BlockMatrix A;
  MatrixXd dense;
};

/// A random matrix that is positive definite because its diagonal outweighs its rows, in elimination order.
System random_system(int n, int depth, std::uint64_t seed) {
  const MatrixX4i tets = grid_tets(n, depth);
  const int size = (n + 1) * (n + 1) * (depth + 1);
  const VectorXi order = elimination_order(block_pattern(tets, VectorXi::LinSpaced(size, 0, size - 1), size));
  VectorXi row_of(size);
  for (int i = 0; i < size; ++i) row_of[order[i]] = i;
  System system{block_pattern(tets, row_of, size), MatrixXd::Zero(3 * size, 3 * size)};
  Random random(seed);
  for (int j = 0; j < size; ++j)
    for (int k = system.A.start[j]; k < system.A.start[j + 1]; ++k) {
      const int i = system.A.row[k];
      Matrix3d block = Matrix3d::NullaryExpr([&random] { return random.normal(); });
      if (i == j) block = (0.5 * (block + block.transpose()) + 90 * Matrix3d::Identity()).eval();
      const Eigen::Matrix3f stored = block.cast<float>();
      std::copy_n(stored.data(), 9, system.A.value.data() + 9 * k);
      system.dense.block<3, 3>(3 * i, 3 * j) = stored.cast<double>();
      system.dense.block<3, 3>(3 * j, 3 * i) = stored.cast<double>().transpose();
    }
  return system;
}

Eigen::VectorXf random_floats(Eigen::Index size, std::uint64_t seed) {
  Random random(seed);
  return Eigen::VectorXf::NullaryExpr(size, [&random] { return static_cast<float>(random.normal()); });
}

TEST(BlockCholesky, SolvesToSinglePrecision) {
  for (const auto& [n, depth] : {std::pair{1, 1}, {2, 1}, {4, 3}, {9, 4}}) {
    const System system = random_system(n, depth, 3);
    BlockCholesky factor(system.A);
    ASSERT_EQ(factor.factorise(system.A), 0);
    const Eigen::VectorXf b = random_floats(system.dense.rows(), 4);
    Eigen::VectorXf x = b;
    factor.solve(x.data());
    EXPECT_LT((system.dense * x.cast<double>() - b.cast<double>()).norm(), 2e-6 * b.cast<double>().norm()) << n;
  }
}

TEST(BlockCholesky, ForwardAndBackwardAreTheTwoHalves) {
  const System system = random_system(5, 2, 5);
  BlockCholesky factor(system.A);
  ASSERT_EQ(factor.factorise(system.A), 0);
  const Eigen::VectorXf a = random_floats(system.dense.rows(), 6), b = random_floats(system.dense.rows(), 7);
  Eigen::VectorXf x = a, y = b;
  factor.forward(x.data());
  factor.forward(y.data());
  // a . A^-1 b
  const double expected = a.cast<double>().dot(system.dense.llt().solve(b.cast<double>()));
  EXPECT_NEAR(x.cast<double>().dot(y.cast<double>()), expected, 1e-6 * x.norm() * y.norm());
}

TEST(BlockCholesky, SeveralSidesAreSolvedAsOne) {
  const System system = random_system(6, 3, 8);
  BlockCholesky factor(system.A);
  ASSERT_EQ(factor.factorise(system.A), 0);
  for (const int sides : {2, 4}) {
    Eigen::MatrixXf room(factor.side_stride(), sides);
    for (int s = 0; s < sides; ++s) room.col(s) = random_floats(room.rows(), 10 + static_cast<std::uint64_t>(s));
    const Eigen::MatrixXf B = room.topRows(system.dense.rows());
    factor.solve(room.data(), sides);
    const Eigen::MatrixXf X = room.topRows(system.dense.rows());
    EXPECT_LT((system.dense * X.cast<double>() - B.cast<double>()).norm(), 2e-6 * B.cast<double>().norm());
  }
}

TEST(BlockCholesky, ARoundedFactorIsNearlyRightAndTheSameInBothHalves) {
  for (const auto& [n, depth] : {std::pair{1, 1}, {4, 3}, {9, 4}, {14, 6}}) {
    const System system = random_system(n, depth, 15);
    BlockCholesky factor(system.A, FactorStorage::rounded);
    ASSERT_EQ(factor.factorise(system.A), 0);
    const Eigen::VectorXf b = random_floats(system.dense.rows(), 16), a = random_floats(system.dense.rows(), 17);
    Eigen::VectorXf x = b;
    factor.solve(x.data());
    const double residual = (system.dense * x.cast<double>() - b.cast<double>()).norm() / b.cast<double>().norm();
    EXPECT_LT(residual, 0.03) << n;
    EXPECT_GT(residual, 1e-5) << n;
    // a . x = (L^-1 a) . (L^-1 b) for the one rounded L.
    Eigen::VectorXf u = a, v = b;
    factor.forward(u.data());
    factor.forward(v.data());
    EXPECT_NEAR(u.cast<double>().dot(v.cast<double>()), a.cast<double>().dot(x.cast<double>()),
                2e-6 * u.norm() * v.norm());
    // Iterations correct what rounding did.
    for (int round = 0; round < 6; ++round) {
      Eigen::VectorXf rest = (b.cast<double>() - system.dense * x.cast<double>()).cast<float>();
      factor.solve(rest.data());
      x += rest;
    }
    EXPECT_LT((system.dense * x.cast<double>() - b.cast<double>()).norm(), 2e-6 * b.cast<double>().norm()) << n;
  }
}

TEST(BlockCholesky, HasTheSameBitsForAnyThreadCountAndForItsTwin) {
  const System system = random_system(14, 6, 9);
  const Eigen::VectorXf b = random_floats(system.dense.rows(), 4);
  BlockCholesky factor(system.A);
  ASSERT_EQ(factor.factorise(system.A), 0);
  Eigen::VectorXf x = b;
  factor.solve(x.data());
  BlockCholesky twin = factor.twin();
  const ThreadLimit one(1);
  ASSERT_EQ(twin.factorise(system.A, false), 0);
  Eigen::VectorXf y = b;
  twin.solve(y.data());
  EXPECT_EQ(x, y);
}

TEST(BlockCholesky, SparseRowsAreSolvedWhereTheyAreNotZero) {
  const System system = random_system(9, 4, 12);
  BlockCholesky factor(system.A);
  ASSERT_EQ(factor.factorise(system.A), 0);
  Random random(13);
  const int vertices = factor.columns();
  const auto some_rows = [&](int count) {
    std::vector<SparseRow> rows(static_cast<std::size_t>(count));
    for (SparseRow& row : rows)
      for (row.count = 0; row.count < 4; ++row.count) {
        row.column[row.count] = static_cast<int>(random.uniform() * vertices);
        row.value[row.count] = random_floats(3, static_cast<std::uint64_t>(1000 * random.uniform()));
      }
    return rows;
  };
  const auto dense = [&](const std::vector<SparseRow>& rows) {
    MatrixXd C = MatrixXd::Zero(SolvedRows::most, 3 * vertices);
    for (std::size_t r = 0; r < rows.size(); ++r)
      for (int k = 0; k < rows[r].count; ++k)
        C.block<1, 3>(static_cast<Eigen::Index>(r), 3 * rows[r].column[k]) +=
            rows[r].value[k].cast<double>().transpose();
    return C;
  };
  const std::vector<SparseRow> a = some_rows(16), b = some_rows(3);
  const SolvedRows A = factor.forward_rows(a), B = factor.forward_rows(b);
  const MatrixXd expected = dense(a) * system.dense.llt().solve(dense(b).transpose());
  EXPECT_LT((A.gram(B).cast<double>() - expected).norm(), 1e-5 * expected.norm());
  const Eigen::VectorXf v = random_floats(3 * vertices, 14);
  Eigen::VectorXf whole = v;
  factor.backward(whole.data());  // C L^-T v
  const VectorXd products = dense(a) * whole.cast<double>();
  EXPECT_LT((A.products(v.data()).cast<double>() - products).norm(), 1e-5 * products.norm());
  Eigen::VectorXf sum = Eigen::VectorXf::Zero(3 * vertices);
  const Eigen::Matrix<float, 16, 1> w = random_floats(16, 15);
  A.add(w, sum.data());
  EXPECT_NEAR(sum.dot(v), w.dot(A.products(v.data())), 1e-5F * sum.norm() * v.norm());
}

TEST(BlockCholesky, TurnsTheSignOfNegativePivots) {
  System system = random_system(4, 2, 11);
  for (int negative = 1; negative <= 3; ++negative) {
    // A pair of unknowns that is bound more strongly than held.
    const auto bound = static_cast<std::size_t>(system.A.start[10 * negative]) + 1;
    system.A.value[9 * bound] = 120;
    const int row = 3 * system.A.row[bound], column = 30 * negative;
    system.dense(row, column) = system.dense(column, row) = 120;
    BlockCholesky factor(system.A);
    EXPECT_EQ(factor.factorise(system.A), negative);
    MatrixXd inverse(system.dense.rows(), system.dense.cols());
    for (Eigen::Index c = 0; c < inverse.cols(); ++c) {
      Eigen::VectorXf e = Eigen::VectorXf::Unit(inverse.rows(), c);
      factor.solve(e.data());
      inverse.col(c) = e.cast<double>();
    }
    const MatrixXd symmetric = 0.5 * (inverse + inverse.transpose());
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<MatrixXd>(symmetric).eigenvalues().minCoeff(), 1e-3);
    const VectorXd change = Eigen::SelfAdjointEigenSolver<MatrixXd>(symmetric.inverse() - system.dense).eigenvalues();
    EXPECT_LT(change.head(change.size() - negative).cwiseAbs().maxCoeff(), 0.02);
    EXPECT_GT(change[change.size() - negative], 10);
  }
}

TEST(BlockCholesky, TellsWhenAMatrixIsNotFiniteAndRecovers) {
  System system = random_system(4, 2, 11);
  BlockCholesky factor(system.A);
  const std::vector<float> good = system.A.value;
  float& entry = system.A.value[9 * static_cast<std::size_t>(system.A.start[7])];
  entry = std::nanf("");
  EXPECT_EQ(factor.factorise(system.A), -1);
  entry = -50;
  EXPECT_EQ(factor.factorise(system.A), 1);
  system.A.value = good;
  EXPECT_EQ(factor.factorise(system.A), 0);
}

}  // namespace
}  // namespace phiz
