// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "phiz/core/random.h"
#include "phiz/numerics/svd3.h"

namespace phiz {
namespace {

Matrix3d random_matrix(Random& random, double scale) {
  Matrix3d A;
  for (int k = 0; k < 9; ++k) A.data()[k] = scale * random.normal();
  return A;
}

TEST(Projections, RotationIsOrthonormalOfDeterminantOneAlsoForInvertedAndSingularInput) {
  Random random(1);
  for (int i = 0; i < 500; ++i) {
    Matrix3d F = random_matrix(random, 1.0);
    if (i % 5 == 0) F.col(2) = F.col(1);
    if (i % 7 == 0) F.setZero();
    const Matrix3d R = closest_rotation(F);
    EXPECT_LT((R * R.transpose() - Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_NEAR(R.determinant(), 1.0, 1e-12);
    EXPECT_LT((closest_rotation(R) - R).norm(), 1e-12);
  }
}

TEST(Projections, UnimodularHasDeterminantOneAndIsIdempotent) {
  Random random(2);
  for (int i = 0; i < 500; ++i) {
    Matrix3d F = random_matrix(random, i % 3 == 0 ? 3.0 : 1.0);
    if (i % 11 == 0) F.col(0).setZero();
    const Matrix3d P = closest_unimodular(F);
    EXPECT_NEAR(P.determinant(), 1.0, 1e-10);
    EXPECT_LT((closest_unimodular(P) - P).norm(), 1e-9);
  }
}

TEST(Projections, NoNearbyUnimodularMatrixIsCloser) {
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const Matrix3d F = Matrix3d::Identity() + random_matrix(random, 0.4);
    const Matrix3d P = closest_unimodular(F);
    for (int k = 0; k < 50; ++k) {
      Matrix3d Q = P + random_matrix(random, 0.02);
      Q /= std::cbrt(Q.determinant());
      EXPECT_GE((Q - F).norm(), (P - F).norm() - 1e-12);
    }
  }
}

TEST(Projections, ResidueOfUnimodularIsParallelToTheGradientOfTheDeterminant) {
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    const Matrix3d F = random_matrix(random, 1.0);
    const Matrix3d P = closest_unimodular(F);
    const Matrix3d cofactor = P.inverse().transpose();  // det P = 1
    const Matrix3d D = P - F;
    const double along = D.cwiseProduct(cofactor).sum() / cofactor.squaredNorm();
    EXPECT_LT((D - along * cofactor).norm(), 1e-7 * (1 + D.norm()));
  }
}

}  // namespace
}  // namespace phiz
