// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "phiz/core/random.h"
#include "phiz/elasticity/terms.h"

namespace phiz {
namespace {

Matrix3d near_identity(Random& random, double spread) {
  Matrix3d A = Matrix3d::Identity();
  for (int k = 0; k < 9; ++k) A.data()[k] += spread * random.normal();
  return Eigen::AngleAxisd(random.uniform(0, 3), Vector3d(1, 2, 3).normalized()) * A;
}

template <class Energy, class Gradient>
void expect_gradient(const Matrix3d& F, Energy&& energy, Gradient&& gradient, double tolerance = 1e-6) {
  const Matrix3d g = gradient(F);
  constexpr double h = 1e-5;
  for (int k = 0; k < 9; ++k) {
    Matrix3d a = F, b = F;
    a.data()[k] -= h;
    b.data()[k] += h;
    EXPECT_NEAR((energy(b) - energy(a)) / (2 * h), g.data()[k], tolerance);
  }
}

template <class Gradient, class Hessian>
void expect_hessian(const Matrix3d& F, Gradient&& gradient, Hessian&& hessian) {
  const Matrix9d H = hessian(F);
  constexpr double h = 1e-5;
  for (int k = 0; k < 9; ++k) {
    Matrix3d a = F, b = F;
    a.data()[k] -= h;
    b.data()[k] += h;
    const Matrix3d column = (gradient(b) - gradient(a)) / (2 * h);
    for (int l = 0; l < 9; ++l) EXPECT_NEAR(column.data()[l], H(l, k), 1e-5);
  }
}

TEST(Terms, DerivativesAgreeWithFiniteDifferences) {
  Random random(5);
  for (int i = 0; i < 20; ++i) {
    const Matrix3d F = near_identity(random, 0.2);
    const Matrix3d spread = near_identity(random, 0.1);
    const Matrix3d S = 0.5 * Matrix3d::Identity() + 0.5 * spread.transpose() * spread;
    const Matrix3d T = near_identity(random, 0.2);
    const auto shape = [&](const Matrix3d& A) { return shape_energy(A, S); };
    const auto shape_slope = [&](const Matrix3d& A) { return shape_gradient(A, S); };
    expect_gradient(F, shape, shape_slope);
    expect_hessian(F, shape_slope, [&](const Matrix3d& A) { return shape_hessian(A, S); });
    expect_gradient(F, volume_energy, volume_gradient);
    expect_hessian(F, volume_gradient, volume_hessian);
    expect_gradient(
        F, [&](const Matrix3d& A) { return target_energy(A, T); },
        [&](const Matrix3d& A) { return target_gradient(A, T); });
  }
}

TEST(Terms, AttachmentAndPlaneDerivativesAgreeWithFiniteDifferences) {
  const Vector3d x(0.1, -0.2, 0.3), point(0.4, 0.1, -0.1), normal = Vector3d(1, 2, -2).normalized();
  constexpr double h = 1e-6;
  for (int k = 0; k < 3; ++k) {
    const Vector3d d = h * Vector3d::Unit(k);
    EXPECT_NEAR((attachment_energy(x + d, point) - attachment_energy(x - d, point)) / (2 * h),
                attachment_gradient(x, point)[k], 1e-8);
    EXPECT_NEAR((plane_energy(x + d, point, normal) - plane_energy(x - d, point, normal)) / (2 * h),
                plane_gradient(x, point, normal)[k], 1e-8);
  }
}

TEST(Terms, RigidMotionCostsNothingInShapeAndVolumeButSomethingInTarget) {
  const Matrix3d R = Eigen::AngleAxisd(0.7, Vector3d(1, 1, 0).normalized()).toRotationMatrix();
  EXPECT_NEAR(shape_energy(R, Matrix3d::Identity()), 0, 1e-20);
  EXPECT_NEAR(volume_energy(R), 0, 1e-20);
  EXPECT_LT(volume_gradient(R).norm(), 1e-12);
  EXPECT_GT(target_energy(R, Matrix3d::Identity()), 0.1);
}

TEST(Terms, ShapeTermVanishesAtEveryRotationOfItsStretch) {
  Matrix3d S = Matrix3d::Identity();
  S(0, 0) = 1.2;
  S(0, 1) = S(1, 0) = 0.1;
  const Matrix3d R = Eigen::AngleAxisd(1.1, Vector3d(0, 1, 2).normalized()).toRotationMatrix();
  EXPECT_NEAR(shape_energy(R * S, S), 0, 1e-20);
}

}  // namespace
}  // namespace phiz
