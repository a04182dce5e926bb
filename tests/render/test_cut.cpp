// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "phiz/core/error.h"
#include "phiz/render/cut.h"
#include "render/shapes.h"

namespace phiz {
namespace {

double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
    const Vector3d a = mesh.V.row(mesh.F(f, 0)), b = mesh.V.row(mesh.F(f, 1)), c = mesh.V.row(mesh.F(f, 2));
    sum += (b - a).cross(c - a).norm() / 2;
  }
  return sum;
}

TEST(Cut, HalfABoxHasHalfItsSides) {
  Surface block = test::surface_of(test::box({0, 0, 0}, {2, 1, 1}));
  block.colour = block.mesh.V;  // linear functions stay linear
  block.transform.translation() = Vector3d(10, 0, 0);
  const Surface half = cut_surface(block, {{11, 0, 0}, {3, 0, 0}});
  EXPECT_NEAR(area(half.mesh), 1 + 4 * 1, 1e-12);
  EXPECT_LE(half.mesh.V.col(0).maxCoeff(), 1 + 1e-12);
  EXPECT_LT((half.colour - half.mesh.V).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(half.wireframe.edges.size(), static_cast<std::size_t>(half.mesh.F.rows()));
}

TEST(Cut, PlaneBesideKeepsAllOrNothing) {
  const Surface block = test::surface_of(test::box({0, 0, 0}, {2, 1, 1}));
  EXPECT_EQ(cut_surface(block, {{5, 0, 0}, {1, 0, 0}}).mesh.F.rows(), 12);
  EXPECT_EQ(cut_surface(block, {{-5, 0, 0}, {1, 0, 0}}).mesh.F.rows(), 0);
  EXPECT_THROW(cut_surface(block, {{0, 0, 0}, {0, 0, 0}}), Error);
}

TEST(Cut, SectionOfACubeOfTetsHasItsAreaAndFacesOutward) {
  TetMesh cube;
  cube.V = test::box({0, 0, 0}, {1, 1, 1}).V;
  cube.T.resize(5, 4);
  cube.T << 0, 1, 2, 4, 3, 2, 1, 7, 5, 4, 7, 1, 6, 7, 4, 2, 1, 2, 4, 7;
  cube.region.resize(5);
  cube.region << 1, 1, 1, 1, 2;
  const std::map<int, Vector3d> colours = {{1, Vector3d(1, 0, 0)}, {2, Vector3d(0, 1, 0)}};
  const Surface section = cross_section(cube, {{0.5, 0, 0}, {1, 0, 0}}, colours);
  EXPECT_NEAR(area(section.mesh), 1, 1e-12);
  double green = 0;
  for (Eigen::Index f = 0; f < section.mesh.F.rows(); ++f) {
    const Vector3d a = section.mesh.V.row(section.mesh.F(f, 0)), b = section.mesh.V.row(section.mesh.F(f, 1)),
                   c = section.mesh.V.row(section.mesh.F(f, 2));
    EXPECT_GT((b - a).cross(c - a).x(), 0);
    green += section.colour(section.mesh.F(f, 0), 1) * (b - a).cross(c - a).norm() / 2;
  }
  EXPECT_NEAR(green, 0.5, 1e-12);  // the inner tet's section is a square over the middles of the sides
}

TEST(Cut, CapOfNestedShellsIsARing) {
  // A hollow block: outer box and an inner one that counts as a hole, whatever its orientation.
  TriangleMesh outer = test::box({0, 0, 0}, {3, 3, 3}), inner = test::box({1, 1, 1}, {2, 2, 2});
  TriangleMesh both;
  both.V.resize(16, 3);
  both.V << outer.V, inner.V;
  both.F.resize(24, 3);
  both.F << outer.F, (inner.F.array() + 8).matrix();
  Surface block = test::surface_of(both);
  block.transform.translate(Vector3d(0, 0, 4)).rotate(Eigen::AngleAxisd(0.3, Vector3d::UnitY()));
  const CutPlane plane{block.transform * Vector3d(1.5, 1.5, 1.5), block.transform.linear() * Vector3d(0, 0, 1)};
  const Surface cut = cap(block, plane);
  EXPECT_NEAR(area(cut.mesh), 8, 1e-9);
  for (Eigen::Index f = 0; f < cut.mesh.F.rows(); ++f) {
    const Vector3d a = cut.mesh.V.row(cut.mesh.F(f, 0)), b = cut.mesh.V.row(cut.mesh.F(f, 1)),
                   c = cut.mesh.V.row(cut.mesh.F(f, 2));
    EXPECT_GT((b - a).cross(c - a).z(), 0);
  }
  EXPECT_EQ(cap(block, {{0, 0, 100}, {0, 0, 1}}).mesh.F.rows(), 0);
}

TEST(Cut, CapOfAnOpenSurfaceIsClosedByAStraightLine) {
  Surface bowl = test::surface_of(test::box({0, 0, 0}, {2, 1, 1}));
  bowl.mesh.F = MatrixX3i(bowl.mesh.F.topRows(10));  // without the side x = 2 or another one
  EXPECT_NEAR(area(cap(bowl, {{1, 0.5, 0.5}, {0, 0, 1}}).mesh), 2, 1e-9);
}

/// Two boxes as one mesh; the second may be turned inside out.
Surface two_boxes(const TriangleMesh& first, const TriangleMesh& second, bool inside_out) {
  TriangleMesh both;
  both.V.resize(16, 3);
  both.V << first.V, second.V;
  both.F.resize(24, 3);
  both.F << first.F, (second.F.array() + 8).matrix();
  if (inside_out) both.F.bottomRows(12).col(1).swap(both.F.bottomRows(12).col(2));
  return test::surface_of(both);
}

TEST(Cut, OverlappingSolidsAreCutAsTheirUnionAndHollowsStayOpen) {
  const TriangleMesh large = test::box({0, 0, 0}, {3, 3, 3}), beside = test::box({2, 1, 0}, {5, 2, 3}),
                     within = test::box({1, 1, 1}, {2, 2, 2});
  const CutPlane plane{{0, 0, 1.5}, {0, 0, 1}};
  EXPECT_NEAR(area(cap(two_boxes(large, beside, false), plane).mesh), 9 + 3 - 2, 1e-9);
  const Surface solids = solid_cap(two_boxes(large, beside, false), plane);
  EXPECT_NEAR(area(solids.mesh), 9 + 3, 1e-9);  // the overlap twice
  EXPECT_NEAR(area(solid_cap(two_boxes(large, within, true), plane).mesh), 8, 1e-9);
}

}  // namespace
}  // namespace phiz
