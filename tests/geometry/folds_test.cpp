// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/geometry/folds.h"

#include <gtest/gtest.h>

#include "geometry/shapes.h"
#include "phiz/geometry/topology.h"

namespace phiz {
namespace {

using test::sphere;

TEST(Folds, ASmoothMotionHasNoneAndStaysBitForBit) {
  const TriangleMesh ball = sphere({0, 0, 0}, 0.1, 4);
  const FoldMender mender(ball, std::vector<char>(static_cast<std::size_t>(ball.V.rows()), 1), -0.5);
  EXPECT_TRUE(mender.folded(ball.V).empty());
  // Squashed to a third, turned and moved.
  Matrix3d squash;
  squash << 0, 1, 0, -1, 0, 0, 0, 0, 0.33;
  const MatrixX3d moved = (ball.V * squash).rowwise() + Eigen::RowVector3d(1, 2, 3);
  MatrixX3d mended = moved;
  EXPECT_EQ(mender.mend(mended), 0);
  EXPECT_EQ(mended, moved);
}

TEST(Folds, AVertexPushedAcrossItsRingIsBroughtBackAndTheRestStays) {
  const TriangleMesh ball = sphere({0, 0, 0}, 0.1, 4);
  const FoldMender mender(ball, std::vector<char>(static_cast<std::size_t>(ball.V.rows()), 1), -0.5);
  const int pushed = 200;
  const auto rings = vertex_neighbours(ball.F, static_cast<int>(ball.V.rows()));
  MatrixX3d V = ball.V;
  V.row(pushed) += 1.8 * (ball.V.row(rings[pushed].front()) - ball.V.row(pushed));
  EXPECT_FALSE(mender.folded(V).empty());
  MatrixX3d mended = V;
  EXPECT_EQ(mender.mend(mended), 0);
  EXPECT_TRUE(mender.folded(mended).empty());
  int moved = 0;
  for (Eigen::Index v = 0; v < mended.rows(); ++v) moved += mended.row(v) != V.row(v);
  EXPECT_LT(moved, 40);
  EXPECT_LT((mended - ball.V).rowwise().norm().maxCoeff(), (V - ball.V).rowwise().norm().maxCoeff());
}

TEST(Folds, WhatIsNotWatchedStays) {
  const TriangleMesh ball = sphere({0, 0, 0}, 0.1, 3);
  const FoldMender mender(ball, std::vector<char>(static_cast<std::size_t>(ball.V.rows()), 0), -0.5);
  MatrixX3d crushed = ball.V;
  crushed.row(7) *= -1;
  EXPECT_TRUE(mender.folded(crushed).empty());
}

}  // namespace
}  // namespace phiz
