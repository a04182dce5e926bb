// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/numerics/rbf.h"

#include <gtest/gtest.h>

#include "numerics/random_matrices.h"
#include "phiz/core/error.h"

namespace phiz {
namespace {

MatrixX3d random_points(int count, std::uint64_t seed) {
  Random random(seed);
  return MatrixX3d::NullaryExpr(count, 3, [&random] { return 0.1 * random.normal(); });
}

class RbfOfKernel : public testing::TestWithParam<RbfKernel> {};

TEST_P(RbfOfKernel, InterpolatesTheValues) {
  const MatrixX3d C = random_points(60, 1);
  const MatrixXd values = random_points(60, 2);
  const Rbf rbf(C, values, GetParam());
  EXPECT_LE((rbf.evaluate(C) - values).cwiseAbs().maxCoeff(), 1e-9);
}

TEST_P(RbfOfKernel, ReproducesAffineMaps) {
  Random random(3);
  const Matrix3d A = test::random_matrix(random);
  const MatrixX3d C = random_points(40, 4), X = random_points(100, 5);
  const Vector3d shift(1, 2, 3);
  const Rbf rbf(C, (C * A).rowwise() + shift.transpose(), GetParam());
  EXPECT_LE((rbf.evaluate(X) - ((X * A).rowwise() + shift.transpose())).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LE((rbf.jacobian(X.row(0)) - A.transpose()).norm(), 1e-8);
}

TEST_P(RbfOfKernel, JacobianAgreesWithDifferences) {
  const Rbf rbf(random_points(30, 6), random_points(30, 7), GetParam());
  const Vector3d x(0.02, -0.03, 0.05);
  const MatrixXd J = rbf.jacobian(x);
  for (int k = 0; k < 3; ++k) {
    const Vector3d h = 1e-6 * Vector3d::Unit(k);
    EXPECT_LE(((rbf(x + h) - rbf(x - h)) / 2e-6 - J.col(k)).norm(), 1e-5 * J.norm());
  }
}

TEST_P(RbfOfKernel, SmoothingTradesFitForSmoothness) {
  const MatrixX3d C = random_points(60, 8);
  const MatrixXd values = random_points(60, 9);
  double before = 0;
  for (const double smoothing : {0.001, 0.1, 10.0}) {
    const double miss = (Rbf(C, values, GetParam(), smoothing).evaluate(C) - values).norm();
    EXPECT_GT(miss, before);
    before = miss;
  }
}

INSTANTIATE_TEST_SUITE_P(Kernels, RbfOfKernel, testing::Values(RbfKernel::biharmonic, RbfKernel::triharmonic));

TEST(Rbf, RefusesTooFewCoincidingAndCoplanarCentres) {
  const MatrixX3d C = random_points(10, 1);
  EXPECT_THROW(Rbf(C.topRows(3), C.topRows(3)), Error);
  EXPECT_THROW(Rbf(C, C.topRows(9)), Error);
  MatrixX3d twice = C;
  twice.row(7) = twice.row(2);
  EXPECT_THROW(Rbf(twice, C), Error);
  MatrixX3d flat = C;
  flat.col(2).setZero();
  EXPECT_THROW(Rbf(flat, C), Error);
}

}  // namespace
}  // namespace phiz
