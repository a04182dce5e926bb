// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "phiz/elasticity/wind.h"

namespace phiz {
namespace {

/// A square of that side in the plane z = 0.
struct Sail {
  MatrixX3d x{4, 3};
  MatrixX3i triangles{2, 3};

  explicit Sail(double side) {
    x << 0, 0, 0, side, 0, 0, side, side, 0, 0, side, 0;
    triangles << 0, 1, 2, 0, 2, 3;
  }
  Vector3d force(const Vector3d& wind, const MatrixX3d& velocity = {}) const {
    return wind_forces(triangles, x, velocity, {wind, 1.2, 0.8}).colwise().sum();
  }
};

TEST(Wind, PressesWithHalfDensityDragAreaAndSquaredSpeed) {
  EXPECT_LT((Sail(0.5).force({0, 0, 3}) - Vector3d(0, 0, 0.5 * 1.2 * 0.8 * 0.25 * 9)).norm(), 1e-14);
}

TEST(Wind, GrowsWithTheAreaAndWithTheSquareOfItsPartAcross) {
  const Vector3d one = Sail(1).force({0, 0, 2});
  EXPECT_NEAR(Sail(3).force({0, 0, 2}).z(), 9 * one.z(), 1e-12);
  for (const double angle : {0.2, 0.7, 1.4}) {
    const double across = std::cos(angle);
    const Vector3d force = Sail(1).force(2 * Vector3d(std::sin(angle), 0, across));
    EXPECT_LT((force - across * across * one).norm(), 1e-13);
  }
}

TEST(Wind, AlongTheSurfaceDoesNothing) {
  EXPECT_EQ(Sail(1).force({5, -3, 0}).norm(), 0);
}

TEST(Wind, PushesDownwindWhicheverWayTheTrianglesTurn) {
  Sail turned(1);
  turned.triangles.col(0).swap(turned.triangles.col(1));
  EXPECT_LT((turned.force({1, 0, -2}) - Sail(1).force({1, 0, -2})).norm(), 1e-14);
  EXPECT_LT(turned.force({1, 0, -2}).z(), 0);
}

TEST(Wind, IsNotFeltByWhatMovesAlongAndFeltInStillAirByWhatMoves) {
  const MatrixX3d velocity = Eigen::RowVector3d(0, 0, 2).replicate(4, 1);
  EXPECT_LT(Sail(1).force({0, 0, 2}, velocity).norm(), 1e-30);
  EXPECT_LT((Sail(1).force({0, 0, 0}, velocity) + Sail(1).force({0, 0, 2})).norm(), 1e-14);
}

TEST(Wind, NonsenseIsRefusedAndFlatTrianglesFeelNothing) {
  Sail sail(1);
  EXPECT_ANY_THROW(sail.force({std::nan(""), 0, 0}));
  EXPECT_ANY_THROW(sail.force({1, 0, 0}, MatrixX3d::Zero(2, 3)));
  sail.triangles.row(0) << 0, 0, 1;
  EXPECT_TRUE(sail.force({0, 0, 1}).allFinite());
  sail.triangles(0, 0) = 9;
  EXPECT_ANY_THROW(sail.force({0, 0, 1}));
}

}  // namespace
}  // namespace phiz
