// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/geometry/surface.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "geometry/shapes.h"
#include "phiz/geometry/topology.h"

namespace phiz {
namespace {

using test::box;
using test::sphere;

TEST(Surface, VolumeAndCentreOfABox) {
  const TriangleMesh mesh = box({1, 2, 3}, {2, 4, 6});
  EXPECT_NEAR(signed_volume(mesh.V, mesh.F), 6, 1e-14);
  EXPECT_LE((volume_centroid(mesh.V, mesh.F) - Vector3d(1.5, 3, 4.5)).norm(), 1e-13);
  EXPECT_NEAR(triangle_areas(mesh.V, mesh.F).sum(), 2 * (2 + 3 + 6), 1e-13);
  EXPECT_LT(signed_volume(mesh.V, mesh.F.rowwise().reverse()), 0);
}

TEST(Surface, NormalsOfABoxCornerAreDiagonalWhateverTheTriangulation) {
  const TriangleMesh mesh = box({-1, -1, -1}, {1, 1, 1});
  const MatrixX3d N = vertex_normals(mesh.V, mesh.F);
  for (int v = 0; v < 8; ++v) EXPECT_LE((N.row(v) - mesh.V.row(v).normalized()).norm(), 1e-14);
}

TEST(Surface, NormalsOfASpherePointOutward) {
  const TriangleMesh mesh = sphere({1, 1, 1}, 2, 4);
  const MatrixX3d N = vertex_normals(mesh.V, mesh.F);
  for (int v = 0; v < mesh.V.rows(); ++v)
    EXPECT_GT(N.row(v).dot((mesh.V.row(v).array() - 1).matrix().normalized()), 0.999);
}

TEST(Surface, AThickenedSheetIsClosedAndHasItsVolume) {
  // The top of a box with a hole of one triangle.
  TriangleMesh sheet;
  constexpr int n = 5;
  sheet.V.resize(n * n, 3);
  for (int i = 0; i < n * n; ++i) sheet.V.row(i) << i % n, i / n, 0;
  sheet.F.resize(2 * (n - 1) * (n - 1) - 1, 3);
  int f = 0;
  for (int y = 0; y + 1 < n; ++y)
    for (int x = 0; x + 1 < n; ++x) {
      const int a = y * n + x;
      sheet.F.row(f++) << a, a + 1, a + n;
      if (x != 1 || y != 1) sheet.F.row(f++) << a + 1, a + n + 1, a + n;
    }
  const TriangleMesh shell = thickened(sheet, 0.25);
  EXPECT_TRUE(is_closed(shell.F));
  EXPECT_TRUE(is_oriented(shell.F));
  EXPECT_NEAR(signed_volume(shell.V, shell.F), 0.25 * 15.5, 1e-12);
  EXPECT_EQ(shell.V.topRows(n * n), sheet.V);
}

TEST(Surface, DegenerateTrianglesAndLoneVerticesGiveZeroNormals) {
  MatrixX3d V(4, 3);
  V << 0, 0, 0, 1, 0, 0, 2, 0, 0, 5, 5, 5;
  MatrixX3i F(1, 3);
  F << 0, 1, 2;
  EXPECT_EQ(triangle_normals(V, F).norm(), 0);
  EXPECT_EQ(vertex_normals(V, F).norm(), 0);
}

PolygonMesh polygon(std::vector<Vector3d> points) {
  PolygonMesh mesh;
  mesh.V.resize(static_cast<Eigen::Index>(points.size()), 3);
  mesh.faces.emplace_back();
  for (std::size_t i = 0; i < points.size(); ++i) {
    mesh.V.row(static_cast<Eigen::Index>(i)) = points[i];
    mesh.faces[0].push_back(static_cast<int>(i));
  }
  return mesh;
}

TEST(Triangulate, AConcaveQuadIsCutInside) {
  for (int turn = 0; turn < 4; ++turn) {
    std::vector<Vector3d> points{{0, 0, 0}, {2, 0, 0}, {0.3, 0.3, 0}, {0, 2, 0}};
    std::rotate(points.begin(), points.begin() + turn, points.end());
    const TriangleMesh mesh = triangulate(polygon(points));
    ASSERT_EQ(mesh.F.rows(), 2);
    const MatrixX3d N = triangle_area_normals(mesh.V, mesh.F);
    EXPECT_GT(N.col(2).minCoeff(), 0);
    EXPECT_NEAR(N.col(2).sum() / 2, 0.6, 1e-14);
  }
}

TEST(Triangulate, AStarKeepsItsAreaAndOrientation) {
  std::vector<Vector3d> points;
  double area = 0;
  for (int i = 0; i < 14; ++i) {
    const double r = i % 2 == 0 ? 1.0 : 0.4, u = 2 * std::numbers::pi * i / 14;
    points.emplace_back(r * std::cos(u), r * std::sin(u), 0);
  }
  for (std::size_t i = 0; i < points.size(); ++i) area += points[i].cross(points[(i + 1) % points.size()])[2] / 2;
  const TriangleMesh mesh = triangulate(polygon(points));
  EXPECT_EQ(mesh.F.rows(), 12);
  const MatrixX3d N = triangle_area_normals(mesh.V, mesh.F);
  EXPECT_GE(N.col(2).minCoeff(), 0);
  EXPECT_NEAR(N.col(2).sum() / 2, area, 1e-13);
}

TEST(Triangulate, AFaceOfThousandsOfCornersIsCutIntoItsArea) {
  constexpr int corners = 3000;  // of a star with shallow spikes
  PolygonMesh mesh;
  mesh.V = MatrixX3d::Zero(corners, 3);
  mesh.faces.resize(1);
  double area = 0;
  for (int i = 0; i < corners; ++i) {
    const double radius = i % 2 == 0 ? 1 : 0.9, angle = 2 * std::numbers::pi * i / corners;
    mesh.V.row(i) << radius * std::cos(angle), radius * std::sin(angle), 0;
    mesh.faces[0].push_back(i);
    area += 0.5 * 0.9 * std::sin(2 * std::numbers::pi / corners);
  }
  const TriangleMesh cut = triangulate(mesh);
  ASSERT_EQ(cut.F.rows(), corners - 2);
  EXPECT_NEAR(triangle_areas(cut.V, cut.F).sum(), area, 1e-9);
}

TEST(Triangulate, TextureCoordinatesAndOwnersFollow) {
  PolygonMesh mesh = polygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}});
  mesh.faces = {{0, 1, 2, 3}, {1, 4, 2}};
  mesh.UV = MatrixX2d::Random(7, 2);
  mesh.face_uvs = {{6, 5, 4, 3}, {2, 1, 0}};
  std::vector<int> owner;
  const TriangleMesh triangles = triangulate(mesh, &owner);
  EXPECT_EQ(owner, (std::vector<int>{0, 0, 1}));
  for (int f = 0; f < 2; ++f)
    for (int k = 0; k < 3; ++k) EXPECT_EQ(triangles.FUV(f, k), 6 - triangles.F(f, k));
  EXPECT_EQ(triangles.FUV.row(2), Eigen::RowVector3i(2, 1, 0));
}

TEST(SelfIntersections, OfSoundSurfacesAreNone) {
  EXPECT_TRUE(self_intersections(box({0, 0, 0}, {1, 1, 1})).empty());
  EXPECT_TRUE(self_intersections(test::torus(1, 0.4, 20, 12)).empty());
  EXPECT_TRUE(self_intersections({}).empty());
}

TEST(SelfIntersections, FindCrossingBoxesFoldsAndDuplicates) {
  const TriangleMesh a = box({0, 0, 0}, {1, 1, 1}), b = box({0.5, 0.5, 0.5}, {2, 2, 2});
  TriangleMesh both;
  both.V.resize(16, 3);
  both.V << a.V, b.V;
  both.F.resize(24, 3);
  both.F << a.F, b.F.array() + 8;
  const auto pairs = self_intersections(both);
  EXPECT_FALSE(pairs.empty());
  for (const auto& [f, g] : pairs) {
    EXPECT_LT(f, 12);
    EXPECT_GE(g, 12);
  }
  TriangleMesh fold;
  fold.V.resize(4, 3);
  fold.V << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0.2, 0.3, 0;
  fold.F.resize(2, 3);
  fold.F << 0, 1, 2, 1, 0, 3;
  EXPECT_EQ(self_intersections(fold).size(), 1U);
  fold.V.row(3) << 0.2, -0.3, 0;
  EXPECT_TRUE(self_intersections(fold).empty());
  fold.F.row(1) << 2, 1, 0;
  EXPECT_EQ(self_intersections(fold).size(), 1U);
}

TEST(Surface, FarthestPointsSpreadOut) {
  const MatrixX3d points = rows_of({{0, 0, 0}, {1, 0, 0}, {4, 0, 0}, {4, 0, 0}, {2, 0, 0}});
  EXPECT_EQ(farthest_points(points, 3), (std::vector<int>{0, 2, 4}));
  EXPECT_EQ(farthest_points(points, 9), (std::vector<int>{0, 2, 4, 1})) << "the point that coincides is left out";
}

}  // namespace
}  // namespace phiz
