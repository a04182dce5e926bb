// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/geometry/coarsen.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "phiz/geometry/geodesic.h"
#include "phiz/geometry/remesh.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/topology.h"

namespace phiz {
namespace {

TriangleMesh fine_ball() {
  PolygoniseOptions options;
  options.edge_length = 0.06;
  return polygonise([](const Vector3d& p) { return p.norm() - 1; }, {Vector3d::Constant(-1.3), Vector3d::Constant(1.3)},
                    options);
}

TEST(Coarsen, KeepsTheSurfaceClosedAndItsVerticesOnIt) {
  const TriangleMesh fine = fine_ball();
  CoarsenOptions options;
  options.edge_length = [](const Vector3d&) { return 0.25; };
  const TriangleMesh coarse = coarsen(fine, options);
  EXPECT_LT(coarse.F.rows(), fine.F.rows() / 8);
  EXPECT_TRUE(is_closed(coarse.F) && is_edge_manifold(coarse.F) && is_vertex_manifold(coarse.F));
  EXPECT_TRUE(is_oriented(coarse.F));
  EXPECT_TRUE(self_intersections(coarse).empty());
  EXPECT_NEAR(coarse.V.rowwise().norm().minCoeff(), 1, 0.01);
  EXPECT_NEAR(coarse.V.rowwise().norm().maxCoeff(), 1, 0.01);
  EXPECT_NEAR(mean_edge_length(coarse.V, coarse.F), 0.25, 0.06);
}

TEST(Coarsen, FollowsTheWantedLengthOverTheSurface) {
  CoarsenOptions options;
  options.edge_length = [](const Vector3d& p) { return p.x() > 0 ? 0.1 : 0.4; };
  const TriangleMesh coarse = coarsen(fine_ball(), options);
  int fine_side = 0, coarse_side = 0;
  for (Eigen::Index v = 0; v < coarse.V.rows(); ++v) ++(coarse.V(v, 0) > 0 ? fine_side : coarse_side);
  EXPECT_GT(fine_side, 5 * coarse_side);
}

TEST(Coarsen, ThinBodiesKeepShortEdges) {
  PolygoniseOptions polygonised;
  polygonised.edge_length = 0.03;
  const TriangleMesh plate = polygonise(
      [](const Vector3d& p) {
        return Vector3d(std::max(std::abs(p.x()) - 0.6, 0.0), std::max(std::abs(p.y()) - 0.6, 0.0), p.z()).norm() -
               0.08;
      },
      {Vector3d::Constant(-0.9), Vector3d::Constant(0.9)}, polygonised);
  CoarsenOptions options;
  options.edge_length = [](const Vector3d&) { return 0.5; };
  options.slenderness = 1;
  const TriangleMesh coarse = coarsen(plate, options);
  EXPECT_LT(mean_edge_length(coarse.V, coarse.F), 0.25);
  EXPECT_TRUE(self_intersections(coarse).empty());
  EXPECT_NEAR(signed_volume(coarse.V, coarse.F), signed_volume(plate.V, plate.F),
              0.1 * signed_volume(plate.V, plate.F));
}

TEST(Geodesic, PathsGoAlongEdgesAndStopAtGaps) {
  MatrixX3d V(6, 3);
  V << 0, 0, 0, 1, 0, 0, 1, 1, 0, 5, 0, 0, 6, 0, 0, 6, 1, 0;
  MatrixX3i F(2, 3);
  F << 0, 1, 2, 3, 4, 5;
  const std::array<int, 1> from{0};
  const VectorXd distance = edge_distances(V, F, from);
  EXPECT_DOUBLE_EQ(distance[1], 1);
  EXPECT_DOUBLE_EQ(distance[2], std::sqrt(2));
  EXPECT_EQ(distance[4], std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace phiz
