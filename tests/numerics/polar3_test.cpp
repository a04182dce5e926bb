// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/numerics/polar3.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "numerics/random_matrices.h"
#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/numerics/svd3.h"

namespace phiz {
namespace {

using test::random_matrix;
using test::random_rotation;

Matrix3d matrix(const Matrices3& M, Eigen::Index i) {
  Matrix3d A;
  for (int k = 0; k < 9; ++k) A.data()[k] = M(i, k);
  return A;
}

void set(Matrices3& M, Eigen::Index i, const Matrix3d& A) {
  for (int k = 0; k < 9; ++k) M(i, k) = A.data()[k];
}

/// Mild, strong, inverted, nearly singular and rotated matrices of many sizes.
Matrices3 nasty(int count) {
  Random random(7);
  Matrices3 A(count, 9);
  for (int i = 0; i < count; ++i) {
    const Matrix3d Q = random_rotation(random);
    Matrix3d F;
    switch (i % 6) {
      case 0:
        F = Q * (Matrix3d::Identity() + 0.1 * random_matrix(random));
        break;
      case 1:
        F = random_matrix(random);
        break;
      case 2:
        F = Q * Vector3d(1, 0.9, -0.2).asDiagonal() * random_rotation(random);
        break;
      case 3:
        F = Q * Vector3d(1, 1e-3, random.uniform(-5e-4, 1e-3)).asDiagonal() * random_rotation(random);
        break;
      case 4:
        F = std::pow(10.0, random.uniform(-90, 90)) * random_matrix(random);
        break;
      default:
        F = Q;
        break;
    }
    set(A, i, F);
  }
  return A;
}

TEST(ClosestRotations, AgreesWithTheSvdWhereverTheRotationIsUnique) {
  const Matrices3 A = nasty(6001);
  Matrices3 R;
  closest_rotations(A, R);
  ASSERT_EQ(R.rows(), A.rows());
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    const Matrix3d Q = matrix(R, i);
    EXPECT_LE((Q.transpose() * Q - Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_NEAR(Q.determinant(), 1, 1e-12);
    const Svd3 svd = svd3(matrix(A, i));
    const double gap = (svd.s[1] + svd.s[2]) / svd.s[0];
    EXPECT_LE((Q - closest_rotation(matrix(A, i))).norm(), 1e-14 / gap + 2e-14) << i << " gap " << gap;
  }
}

TEST(ClosestRotations, OfZeroAndTinyAndHugeMatricesAreRotations) {
  Matrices3 A = Matrices3::Zero(5, 9);
  set(A, 1, 1e-300 * Matrix3d::Identity());
  set(A, 2, 1e150 * Matrix3d::Identity());
  set(A, 3, -Matrix3d::Identity());
  set(A, 4, Vector3d(1, 0, 0).asDiagonal());
  Matrices3 R;
  closest_rotations(A, R);
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    EXPECT_NEAR(matrix(R, i).determinant(), 1, 1e-12);
    EXPECT_LE((matrix(R, i).transpose() * matrix(R, i) - Matrix3d::Identity()).norm(), 1e-12);
  }
  EXPECT_LE((matrix(R, 1) - Matrix3d::Identity()).norm(), 1e-13);
  EXPECT_LE((matrix(R, 2) - Matrix3d::Identity()).norm(), 1e-13);
}

TEST(ClosestRotations, AreIdempotent) {
  Matrices3 R, again;
  closest_rotations(nasty(600), R);
  closest_rotations(R, again);
  EXPECT_LE((R - again).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(ClosestUnimodulars, AgreeWithTheScalarProjection) {
  Matrices3 A = nasty(3001), P;
  for (Eigen::Index i = 4; i < A.rows(); i += 6) A.row(i) /= A.row(i).norm();
  closest_unimodulars(A, P);
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    EXPECT_NEAR(matrix(P, i).determinant(), 1, 1e-11);
    EXPECT_NEAR((matrix(P, i) - matrix(A, i)).norm(), (closest_unimodular(matrix(A, i)) - matrix(A, i)).norm(), 1e-10);
  }
}

TEST(Polar3, GivesTheSameBitsForAnyNumberOfThreads) {
  const Matrices3 A = nasty(20000);
  Matrices3 R, P, R1, P1;
  closest_rotations(A, R);
  closest_unimodulars(A, P);
  const ThreadLimit limit(1);
  closest_rotations(A, R1);
  closest_unimodulars(A, P1);
  EXPECT_EQ(R, R1);
  EXPECT_EQ(P, P1);
}

TEST(Polar3, RefusesWhatIsNotFinite) {
  Matrices3 A = nasty(100), R;
  A(42, 3) = std::nan("");
  EXPECT_THROW(closest_rotations(A, R), Error);
  EXPECT_THROW(closest_unimodulars(A, R), Error);
}

}  // namespace
}  // namespace phiz
