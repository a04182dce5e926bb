// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/geometry/remesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geometry/shapes.h"
#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/topology.h"
#include "phiz/geometry/validate.h"

namespace phiz {
namespace {

constexpr double pi = std::numbers::pi;

double ball_distance(const Vector3d& p) {
  return p.norm() - 0.05;
}

double ring_distance(const Vector3d& p) {
  return std::hypot(std::hypot(p[0], p[2]) - 0.04, p[1]) - 0.012;
}

TEST(Polygonise, ASphereIsClosedManifoldAndExact) {
  PolygoniseOptions options;
  options.edge_length = 0.004;
  const TriangleMesh mesh = polygonise(ball_distance, {Vector3d::Constant(-0.06), Vector3d::Constant(0.06)}, options);
  require_closed_manifold(mesh, "sphere");
  EXPECT_TRUE(self_intersections(mesh).empty());
  EXPECT_LT((mesh.V.rowwise().norm().array() - 0.05).abs().maxCoeff(), 1e-9);
  EXPECT_NEAR(signed_volume(mesh.V, mesh.F), 4 * pi / 3 * std::pow(0.05, 3), 0.005 * 4 * pi / 3 * std::pow(0.05, 3));
  EXPECT_NEAR(mean_edge_length(mesh.V, mesh.F), 0.004, 0.0008);
}

TEST(Polygonise, ATorusKeepsItsHole) {
  PolygoniseOptions options;
  options.edge_length = 0.004;
  const TriangleMesh mesh = polygonise(ring_distance, {Vector3d::Constant(-0.07), Vector3d::Constant(0.07)}, options);
  require_closed_manifold(mesh, "torus");
  EXPECT_EQ(mesh.V.rows() - edges(mesh.F).rows() + mesh.F.rows(), 0);
}

TEST(Polygonise, SkippingFarBlocksChangesNothing) {
  PolygoniseOptions options;
  options.edge_length = 0.003;
  const Box box{Vector3d::Constant(-0.09), Vector3d::Constant(0.07)};
  const TriangleMesh all = polygonise(ring_distance, box, options);
  options.lipschitz = 1;
  const TriangleMesh skipped = polygonise(ring_distance, box, options);
  EXPECT_EQ(all.V, skipped.V);
  EXPECT_EQ(all.F, skipped.F);
}

TEST(Polygonise, GivesTheSameMeshForAnyNumberOfThreads) {
  PolygoniseOptions options;
  options.edge_length = 0.005;
  const Box box{Vector3d::Constant(-0.07), Vector3d::Constant(0.07)};
  const TriangleMesh parallel = polygonise(ring_distance, box, options);
  const ThreadLimit limit(1);
  const TriangleMesh serial = polygonise(ring_distance, box, options);
  EXPECT_EQ(parallel.V, serial.V);
  EXPECT_EQ(parallel.F, serial.F);
}

TEST(Polygonise, RefusesShapesThatLeaveTheBoxOrAreEmptyOrNotFinite) {
  PolygoniseOptions options;
  options.edge_length = 0.01;
  EXPECT_THROW(polygonise(ball_distance, {Vector3d::Constant(-0.04), Vector3d::Constant(0.06)}, options), Error);
  EXPECT_THROW(polygonise([](const Vector3d&) { return 1.0; }, {}, {0.1}), Error);
  EXPECT_THROW(polygonise([](const Vector3d&) { return std::nan(""); }, {}, {0.1}), Error);
  EXPECT_THROW(polygonise(ball_distance, {}, {}), Error);
}

TEST(Remesh, GivesTheWantedEdgeOnASphere) {
  const TriangleMesh fine = test::sphere({0, 0, 0}, 1, 5);
  RemeshOptions options;
  options.edge_length = 0.15;
  const TriangleMesh mesh = remesh_isotropic(fine, options);
  require_closed_manifold(mesh, "sphere");
  EXPECT_NEAR(mean_edge_length(mesh.V, mesh.F), 0.15, 0.03);
  EXPECT_LT((mesh.V.rowwise().norm().array() - 1).abs().maxCoeff(), 0.002);
}

TEST(Remesh, KeepsSharpEdgesOfABox) {
  RemeshOptions options;
  options.edge_length = 0.2;
  options.sharp_angle = 60;
  const TriangleMesh mesh = remesh_isotropic(test::box({0, 0, 0}, {1, 1, 1}), options);
  require_closed_manifold(mesh, "box");
  EXPECT_NEAR(signed_volume(mesh.V, mesh.F), 1, 1e-9);
}

TEST(Remesh, RefusesNonManifoldInput) {
  TriangleMesh mesh = test::box({0, 0, 0}, {1, 1, 1});
  mesh.F.conservativeResize(13, 3);
  mesh.F.row(12) = mesh.F.row(0);
  RemeshOptions options;
  options.edge_length = 0.2;
  EXPECT_THROW(remesh_isotropic(mesh, options), Error);
  EXPECT_THROW(remesh_isotropic(test::box({0, 0, 0}, {1, 1, 1}), {}), Error);
}

TEST(Decimate, ReachesTheTargetAndKeepsTheShape) {
  const TriangleMesh fine = test::sphere({0, 0, 0}, 1, 5);
  const TriangleMesh mesh = decimate(fine, 500);
  require_closed_manifold(mesh, "sphere");
  EXPECT_NEAR(static_cast<double>(mesh.F.rows()), 500, 10);
  EXPECT_LT((mesh.V.rowwise().norm().array() - 1).abs().maxCoeff(), 0.03);
}

}  // namespace
}  // namespace phiz
