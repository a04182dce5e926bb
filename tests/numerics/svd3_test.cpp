// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/numerics/svd3.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <vector>

#include "numerics/random_matrices.h"
#include "phiz/core/error.h"

namespace phiz {
namespace {

using test::random_matrix;
using test::random_rotation;

void expect_decomposition(const Matrix3d& A) {
  const Svd3 svd = svd3(A);
  const double size = std::max(A.norm(), std::numeric_limits<double>::min());
  EXPECT_LE((svd.U * svd.s.asDiagonal() * svd.V.transpose() - A).norm() / size, 1e-14) << A;
  EXPECT_LE((svd.U.transpose() * svd.U - Matrix3d::Identity()).norm(), 1e-14) << A;
  EXPECT_LE((svd.V.transpose() * svd.V - Matrix3d::Identity()).norm(), 1e-14) << A;
  EXPECT_NEAR(svd.U.determinant(), 1, 1e-14);
  EXPECT_NEAR(svd.V.determinant(), 1, 1e-14);
  EXPECT_GE(svd.s[0], svd.s[1]);
  EXPECT_GE(svd.s[1], std::abs(svd.s[2]));
}

TEST(Svd3, DecomposesRandomInvertedSingularAndExtremeMatrices) {
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const Matrix3d A = random_matrix(random);
    expect_decomposition(A);
    expect_decomposition(std::pow(10.0, random.uniform(-150, 150)) * A);
    Matrix3d flat = A;
    flat.col(2) = flat.col(0) - 2 * flat.col(1);
    expect_decomposition(flat);
    Matrix3d line = A;
    line.col(1) = 3 * line.col(0);
    line.col(2) = -line.col(0);
    expect_decomposition(line);
    expect_decomposition(random_rotation(random));
    expect_decomposition(random_rotation(random) * Vector3d(1, 1e-8, 1e-16).asDiagonal() * random_rotation(random));
  }
  expect_decomposition(Matrix3d::Zero());
  expect_decomposition(-Matrix3d::Identity());
  expect_decomposition(Vector3d(0, 0, 5).asDiagonal());
}

TEST(Svd3, KeepsSmallSingularValuesOfScaledColumns) {
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    const Vector3d s(1, 1e-7, 1e-13);
    const Svd3 svd = svd3(random_rotation(random) * s.asDiagonal());
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(svd.s[k] / s[k], 1, 1e-12);
  }
}

TEST(Svd3, RefusesWhatIsNotFinite) {
  Matrix3d A = Matrix3d::Identity();
  A(1, 1) = std::nan("");
  EXPECT_THROW(svd3(A), Error);
}

TEST(ClosestRotation, IsNoFartherThanAnyOtherRotation) {
  Random random(3);
  for (int i = 0; i < 300; ++i) {
    const Matrix3d A = random_matrix(random);
    const Matrix3d R = closest_rotation(A);
    EXPECT_NEAR(R.determinant(), 1, 1e-14);
    for (int j = 0; j < 30; ++j) EXPECT_LE((R - A).norm(), (random_rotation(random) - A).norm() + 1e-14);
  }
}

TEST(ClosestRotation, RecoversTheRotationOfAPositiveStretch) {
  Random random(4);
  for (int i = 0; i < 300; ++i) {
    const Matrix3d R = random_rotation(random), Q = random_rotation(random);
    const Matrix3d stretch =
        Q * Vector3d(random.uniform(0.1, 3), random.uniform(0.1, 3), random.uniform(0.1, 3)).asDiagonal() *
        Q.transpose();
    EXPECT_LE((closest_rotation(R * stretch) - R).norm(), 1e-13);
  }
}

TEST(ClosestUnimodular, HasDeterminantOneAndIsNoFartherThanItsNeighboursAndRivals) {
  Random random(5);
  for (int i = 0; i < 500; ++i) {
    const Matrix3d A = random.uniform(0.2, 2.5) * random_matrix(random);
    const Matrix3d P = closest_unimodular(A);
    EXPECT_NEAR(P.determinant(), 1, 1e-12);
    for (int j = 0; j < 50; ++j) {
      Matrix3d rival = P + random.uniform(0, 0.3) * random_matrix(random);
      if (!(rival.determinant() > 0)) continue;
      rival /= std::cbrt(rival.determinant());
      EXPECT_LE((P - A).norm(), (rival - A).norm() + 1e-9);
    }
  }
}

TEST(ClosestUnimodular, LeavesDeterminantOneAlone) {
  Random random(6);
  for (int i = 0; i < 100; ++i) {
    Matrix3d A = random_rotation(random) * (Matrix3d::Identity() + 0.3 * random_matrix(random));
    if (A.determinant() < 0.2) continue;
    A /= std::cbrt(A.determinant());
    EXPECT_LE((closest_unimodular(A) - A).norm(), 1e-12);
  }
}

TEST(ClosestUnimodular, OfAUniformScaleIsTheRotationNearOneAndCollapsesOneAxisFarFromIt) {
  EXPECT_LE((closest_unimodular(1.3 * Matrix3d::Identity()) - Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_LE((closest_unimodular(0.1 * Matrix3d::Identity()) - Matrix3d::Identity()).norm(), 1e-12);
  // t (3 - t)^2 = 1: keeping two axes long is nearer to 3 I than the identity is.
  const Vector3d p = closest_unimodular_values({3, 3, 3});
  EXPECT_LT((p - Vector3d(3, 3, 3)).norm(), std::sqrt(12.0));
  EXPECT_NEAR(p.prod(), 1, 1e-12);
}

}  // namespace
}  // namespace phiz
