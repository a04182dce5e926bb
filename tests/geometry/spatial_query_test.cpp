// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/geometry/spatial_query.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "geometry/shapes.h"
#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/core/random.h"
#include "phiz/geometry/tetrahedralise.h"

namespace phiz {
namespace {

using test::box;
using test::sphere;

MatrixX3d random_points(int count, double reach, std::uint64_t seed) {
  Random random(seed);
  return MatrixX3d::NullaryExpr(count, 3, [&] { return random.uniform(-reach, reach); });
}

TEST(SurfaceQuery, ClosestPointAgreesWithTryingEveryTriangle) {
  const TriangleMesh mesh = test::torus(1, 0.4, 24, 16);
  const SurfaceQuery query(mesh);
  const MatrixX3d P = random_points(500, 2, 1);
  const auto found = query.closest_points(P);
  for (Eigen::Index i = 0; i < P.rows(); ++i) {
    double best = 1e30;
    for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
      const Vector3d a = mesh.V.row(mesh.F(f, 0)), b = mesh.V.row(mesh.F(f, 1)), c = mesh.V.row(mesh.F(f, 2));
      const Vector3d w = closest_barycentric(P.row(i), a, b, c);
      best = std::min(best, (w[0] * a + w[1] * b + w[2] * c - P.row(i).transpose()).squaredNorm());
    }
    const SurfacePoint& q = found[static_cast<std::size_t>(i)];
    EXPECT_NEAR(q.squared_distance, best, 1e-15);
    EXPECT_NEAR(q.barycentric.sum(), 1, 1e-15);
    EXPECT_GE(q.barycentric.minCoeff(), 0);
    EXPECT_NEAR((q.position - P.row(i).transpose()).squaredNorm(), q.squared_distance, 1e-15);
  }
}

TEST(SurfaceQuery, ClosestPointOfATriangleIsNoFartherThanAnySample) {
  Random random(3);
  const auto point = [&random] { return Vector3d(random.normal(), random.normal(), random.normal()); };
  for (int i = 0; i < 500; ++i) {
    const Vector3d a = point(), b = point(), c = i % 5 == 0 ? Vector3d(0.5 * (a + b)) : point(), p = 2 * point();
    const Vector3d w = closest_barycentric(p, a, b, c);
    const double distance = (w[0] * a + w[1] * b + w[2] * c - p).norm();
    for (int j = 0; j < 50; ++j) {
      double u = random.uniform(), v = random.uniform();
      if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
      }
      EXPECT_LE(distance, ((1 - u - v) * a + u * b + v * c - p).norm() + 1e-12);
    }
  }
}

TEST(SurfaceQuery, BoundedSearchFindsOnlyWhatIsNear) {
  const SurfaceQuery query(sphere({0, 0, 0}, 1, 4));
  EXPECT_FALSE(query.closest_point_within({3, 0, 0}, 1.9));
  EXPECT_TRUE(query.closest_point_within({3, 0, 0}, 2.1));
}

TEST(SurfaceQuery, RaysHitBothSidesInOrder) {
  const SurfaceQuery query(box({0, 0, 0}, {1, 1, 1}));
  const auto first = query.first_hit({0.3, 0.4, -2}, {0, 0, 1});
  ASSERT_TRUE(first);
  EXPECT_NEAR(first->t, 2, 1e-14);
  const auto all = query.all_hits({0.3, 0.4, -2}, {0, 0, 1});
  ASSERT_EQ(all.size(), 2U);
  EXPECT_NEAR(all[1].t, 3, 1e-14);
  EXPECT_FALSE(query.first_hit({0.3, 0.4, -2}, {0, 0, -1}));
  EXPECT_FALSE(query.first_hit({0.3, 0.4, -2}, {0, 0, 1}, 0, 1.5));
  EXPECT_TRUE(query.first_hit({0.3, 0.4, 0.5}, {0.3, 0.2, 0.1}));
}

TEST(SurfaceQuery, InsideOfSpheresBoxesAndTori) {
  const SurfaceQuery query(test::torus(1, 0.4, 60, 40));
  const MatrixX3d P = random_points(2000, 1.6, 2);
  const VectorXd winding = query.winding_numbers(P);
  for (Eigen::Index i = 0; i < P.rows(); ++i) {
    const double distance = std::hypot(std::hypot(P(i, 0), P(i, 2)) - 1, P(i, 1)) - 0.4;
    if (std::abs(distance) < 0.01) continue;
    EXPECT_NEAR(winding[i], distance < 0 ? 1 : 0, 0.03);
    EXPECT_EQ(query.is_inside(P.row(i)), distance < 0);
  }
}

TEST(SurfaceQuery, SignedDistanceOfASphere) {
  const SurfaceQuery query(sphere({0.1, 0, 0}, 0.5, 6));
  const MatrixX3d P = random_points(300, 1, 4);
  const VectorXd distance = query.signed_distances(P);
  for (Eigen::Index i = 0; i < P.rows(); ++i)
    EXPECT_NEAR(distance[i], (P.row(i) - Eigen::RowVector3d(0.1, 0, 0)).norm() - 0.5, 5e-4);
}

TEST(SurfaceQuery, AnOpenSurfaceStillHasAnInside) {
  TriangleMesh mesh = sphere({0, 0, 0}, 1, 4);
  mesh.F.conservativeResize(mesh.F.rows() - 60, 3);
  const SurfaceQuery query(mesh);
  EXPECT_TRUE(query.is_inside({0, 0, 0}));
  EXPECT_FALSE(query.is_inside({0, 3, 0}));
}

TEST(SurfaceQuery, RefittedTreeAnswersLikeANewOne) {
  TriangleMesh mesh = sphere({0, 0, 0}, 1, 4);
  SurfaceQuery query(mesh);
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) mesh.V(v, 1) *= 1 + 0.5 * mesh.V(v, 0);
  query.refit(mesh.V);
  const SurfaceQuery fresh(mesh);
  const MatrixX3d P = random_points(200, 1.5, 5);
  for (Eigen::Index i = 0; i < P.rows(); ++i) {
    EXPECT_NEAR(query.closest_point(P.row(i)).squared_distance, fresh.closest_point(P.row(i)).squared_distance, 1e-15);
    EXPECT_NEAR(query.winding_number(P.row(i)), fresh.winding_number(P.row(i)), 0.03);
  }
}

TEST(SurfaceQuery, BoxSearchFindsTheFace) {
  const SurfaceQuery query(box({0, 0, 0}, {1, 1, 1}));
  EXPECT_EQ(query.triangles_in_box({0.4, 0.4, 0.9}, {0.6, 0.6, 1.1}).size(), 2U);
  EXPECT_EQ(query.triangles_in_box({-1, -1, -1}, {2, 2, 2}).size(), 12U);
  EXPECT_TRUE(query.triangles_in_box({0.4, 0.4, 0.4}, {0.6, 0.6, 0.6}).empty());
}

TEST(SurfaceQuery, RefusesEmptyBrokenAndNotFiniteInput) {
  EXPECT_THROW(SurfaceQuery{TriangleMesh{}}, Error);
  TriangleMesh mesh = box({0, 0, 0}, {1, 1, 1});
  mesh.F(0, 0) = 99;
  EXPECT_THROW(SurfaceQuery{mesh}, Error);
  mesh = box({0, 0, 0}, {1, 1, 1});
  mesh.V(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(SurfaceQuery{mesh}, Error);
  const SurfaceQuery query(box({0, 0, 0}, {1, 1, 1}));
  EXPECT_THROW(query.closest_point({std::nan(""), 0, 0}), Error);
}

TEST(SurfaceQuery, GivesTheSameBitsForAnyNumberOfThreads) {
  const SurfaceQuery query(test::torus(1, 0.4, 40, 30));
  const MatrixX3d P = random_points(2000, 2, 6);
  const VectorXd parallel = query.signed_distances(P);
  const ThreadLimit limit(1);
  EXPECT_EQ(parallel, query.signed_distances(P));
}

TEST(TetQuery, LocatesPointsAndRestoresThem) {
  const RegionSurface skin{"skin", sphere({0, 0, 0}, 1, 3), 1, false, 0.4};
  const TetMesh mesh = tetrahedralise(std::span(&skin, 1));
  const TetQuery query(mesh);
  const MatrixX3d P = random_points(500, 0.9, 7);
  const auto located = query.locate_all(P);
  const auto nearest = query.nearest_all(P);
  const MatrixX3d restored = interpolation_matrix(nearest, mesh.T, mesh.V.rows()) * mesh.V;
  const SurfaceQuery surface(skin.surface);
  for (Eigen::Index i = 0; i < P.rows(); ++i) {
    const auto& at = located[static_cast<std::size_t>(i)];
    EXPECT_EQ(at.tet >= 0, surface.is_inside(P.row(i)));
    EXPECT_NEAR(nearest[static_cast<std::size_t>(i)].barycentric.sum(), 1, 1e-12);
    if (at.tet >= 0) {
      EXPECT_LE((restored.row(i) - P.row(i)).norm(), 1e-12);
    } else {
      EXPECT_LE((restored.row(i).transpose() - surface.closest_point(P.row(i)).position).norm(), 1e-12);
    }
  }
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) EXPECT_TRUE(query.locate(mesh.V.row(v))) << v;
}

TEST(TetQuery, RefusesAnEmptyMesh) {
  EXPECT_THROW(TetQuery{TetMesh{}}, Error);
}

TEST(InterpolationMatrix, OfSurfacePointsRestoresThem) {
  const TriangleMesh mesh = sphere({0, 0, 0}, 1, 3);
  const auto points = closest_points(mesh, random_points(50, 2, 8));
  const MatrixX3d restored = interpolation_matrix(points, mesh.F, mesh.V.rows()) * mesh.V;
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_LE((restored.row(static_cast<Eigen::Index>(i)).transpose() - points[i].position).norm(), 1e-14);
}

}  // namespace
}  // namespace phiz
