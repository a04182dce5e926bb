// SPDX-License-Identifier: GPL-3.0-or-later
// The prefactored matrix and its quasi-Newton correction against dense algebra.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <utility>
#include <vector>

#include "elasticity/blocks.h"
#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/core/random.h"
#include "phiz/elasticity/low_rank_inverse.h"
#include "phiz/elasticity/vector_kernel.h"
#include "phiz/elasticity/vertex_solver.h"
#include "phiz/geometry/operators.h"

namespace phiz {
namespace {

using Eigen::Index;
using Eigen::VectorXf;
using RowsOf4 = Eigen::Matrix<float, Eigen::Dynamic, 4, Eigen::RowMajor>;

MatrixXd random_matrix(Index rows, Index cols, Random& random) {
  MatrixXd m(rows, cols);
  for (Index i = 0; i < m.size(); ++i) m.data()[i] = random.normal();
  return m;
}

/// Laplacian of a box held by a unit spring at every vertex, in its order of elimination.
SparseMatrixd ordered_matrix() {
  const TetMesh mesh = testing::box(Vector3d::Zero(), Vector3d(1, 1, 1), 6, 5, 4);
  SparseMatrixd A = tet_laplacian(mesh.V, mesh.T);
  for (Index v = 0; v < A.rows(); ++v) A.coeffRef(v, v) += 1;
  const VectorXi order = elimination_order(A);
  Eigen::PermutationMatrix<Eigen::Dynamic> P(order);
  return P.transpose() * A * P;
}

TEST(VertexSolver, OrderIsAPermutation) {
  VectorXi order = elimination_order(ordered_matrix());
  std::sort(order.data(), order.data() + order.size());
  EXPECT_EQ(order, VectorXi(VectorXi::LinSpaced(order.size(), 0, static_cast<int>(order.size()) - 1)));
}

TEST(VertexSolver, AgreesWithADenseFactorAndWithItselfForAnyNumberOfThreads) {
  const SparseMatrixd A = ordered_matrix();
  const MatrixXd inverse = MatrixXd(A).inverse();
  const Index n = A.rows();
  Random random(3);
  const RowsOf4 b = random_matrix(n, 4, random).cast<float>();
  const MatrixXd expected = inverse * b.leftCols(3).cast<double>();
  const FloatVector x = float_vector(4 * n);
  Eigen::Map<RowsOf4> solution(x.get(), n, 4);
  RowsOf4 first;
  for (const int threads : {1, 4}) {
    const ThreadLimit limit(threads);
    const VertexSolver solver(A);
    ASSERT_EQ(solver.rows(), n);
    solution = b;
    solver.solve(x.get());
    EXPECT_LT((solution.leftCols(3).cast<double>() - expected).cwiseAbs().maxCoeff(), 2e-6);
    EXPECT_EQ(solution.col(3).cwiseAbs().maxCoeff(), 0.0F) << "the fourth column becomes zero";
    if (threads == 1) first = solution;
    EXPECT_TRUE(solution == first);
  }
  const VectorXi some = (VectorXi(4) << 0, 17, 60, static_cast<int>(n) - 1).finished();
  EXPECT_LT((VertexSolver(A).inverse_block(some) - inverse(some, some)).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(VertexSolver, AMatrixThatIsNotPositiveDefiniteIsRefused) {
  SparseMatrixd A = ordered_matrix();
  A.coeffRef(5, 5) = -1;
  EXPECT_THROW(VertexSolver{A}, Error);
}

/// The BFGS update of an inverse, as it stands in textbooks.
MatrixXd updated(const MatrixXd& H, const VectorXd& s, const VectorXd& y) {
  const double rho = 1 / s.dot(y);
  const MatrixXd V = MatrixXd::Identity(H.rows(), H.rows()) - rho * y * s.transpose();
  return V.transpose() * H * V + rho * s * s.transpose();
}

/// A vector in the layout of the class.
FloatVector stored(const VectorXd& v) {
  FloatVector x = float_vector(v.size());
  Eigen::Map<VectorXf>(x.get(), v.size()) = v.cast<float>();
  return x;
}

/// All of [S, gamma Z].
MatrixXd all_rows(const LowRankInverse& H, Index n) {
  MatrixXd wide(n, 2 * H.pairs());
  for (Index first = 0; first < n; first += 3) wide.middleRows<3>(first) = H.rows(first);
  return wide;
}

TEST(LowRankInverse, CompactFormEqualsTheTextbookRecursionOverTheNewestPairs) {
  Random random(4);
  const Index n = 24;
  const int history = 3;
  const MatrixXd B = random_matrix(n, n, random);
  const MatrixXd A = B * B.transpose() / static_cast<double>(n) + MatrixXd::Identity(n, n);
  const MatrixXd A_inverse = A.inverse(), curvature = A + 0.3 * MatrixXd::Identity(n, n);
  LowRankInverse H(n, history, 1.4);
  const FloatVector product = float_vector(n);
  const auto times = [&](const VectorXd& v, const VectorXd& u, double sign) {
    H.apply(stored(A_inverse * v).get(), H.middle(u), sign, product.get());
    return VectorXd(Eigen::Map<const VectorXf>(product.get(), n).cast<double>());
  };
  VectorXd g = random_matrix(n, 1, random);
  H.start(stored(g).get());
  EXPECT_LT((times(g, H.projection(), 1) - 1.4 * A_inverse * g).cwiseAbs().maxCoeff(), 2e-6);
  std::vector<std::pair<VectorXd, VectorXd>> pairs;
  for (int k = 0; k < 5; ++k) {  // more than are kept
    const VectorXd s = random_matrix(n, 1, random), y = curvature * s;
    g += y;
    H.add(stored(s).get(), stored(y).get(), stored(A_inverse * y).get(), stored(g).get());
    pairs.emplace_back(s, y);
    ASSERT_EQ(H.pairs(), std::min(k + 1, history));
    MatrixXd expected = H.gamma() * A_inverse;
    for (int i = k + 1 - H.pairs(); i <= k; ++i)
      expected = updated(expected, pairs[static_cast<std::size_t>(i)].first, pairs[static_cast<std::size_t>(i)].second);
    const MatrixXd wide = all_rows(H, n);
    EXPECT_LT((H.gamma() * A_inverse + wide * H.middle() * wide.transpose() - expected).cwiseAbs().maxCoeff(), 1e-6);
    EXPECT_LT((H.projection() - wide.transpose() * g).norm(), 1e-6 * (wide.norm() * g.norm()));
    EXPECT_LT((times(g, H.projection(), -1) + expected * g).norm(), 1e-6 * g.norm());
    const VectorXd v = random_matrix(n, 1, random);
    EXPECT_LT((times(v, wide.transpose() * v, 1) - expected * v).norm(), 1e-6 * v.norm());
    EXPECT_LT((times(y, wide.transpose() * y, 1) - s).norm(), 1e-6 * y.norm()) << "the newest pair is met";
  }
}

TEST(LowRankInverse, APairWithoutPositiveCurvatureIsRefusedButTheGradientIsFollowed) {
  LowRankInverse H(3, 4);
  VectorXd g = Vector3d(1, 2, 3);
  H.start(stored(g).get());
  const auto step = [&](const Vector3d& s, const Vector3d& y) {
    g += y;
    H.add(stored(s).get(), stored(y).get(), stored(y).get(), stored(g).get());
  };
  const Vector3d bent(-1, 1, 0);
  step(Vector3d::UnitX(), bent);
  EXPECT_EQ(H.pairs(), 0);
  step(Vector3d::UnitX(), Vector3d::UnitX());
  ASSERT_EQ(H.pairs(), 1);
  const double gamma = H.gamma();
  step(Vector3d::UnitX(), bent);
  EXPECT_EQ(H.pairs(), 1);
  EXPECT_EQ(H.gamma(), gamma);
  EXPECT_LT((H.projection() - all_rows(H, 3).transpose() * g).norm(), 1e-6);
}

}  // namespace
}  // namespace phiz
