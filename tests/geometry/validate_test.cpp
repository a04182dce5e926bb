// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/geometry/validate.h"

#include <gtest/gtest.h>

#include <limits>

#include "geometry/shapes.h"
#include "phiz/core/error.h"

namespace phiz {
namespace {

using test::box;

/// The message with which `call` is refused as bad input, or "" when it is accepted.
template <class Call>
std::string refusal(Call&& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    return error.what();
  }
  return "";
}

TEST(ValidateTriangles, AcceptsGoodAndEmptyMeshes) {
  EXPECT_EQ(refusal([] { validate(box({0, 0, 0}, {1, 1, 1}), "box"); }), "");
  EXPECT_EQ(refusal([] { validate(TriangleMesh{}, "nothing"); }), "");
}

TEST(ValidateTriangles, NamesFileElementAndReason) {
  TriangleMesh mesh = box({0, 0, 0}, {1, 1, 1});
  mesh.F(5, 1) = 8;
  EXPECT_EQ(refusal([&] { validate(mesh, "a.obj"); }), "a.obj: triangle 5 refers to vertex 8, but there are 8");
  mesh.F(5, 1) = -1;
  EXPECT_NE(refusal([&] { validate(mesh, "a.obj"); }), "");
  mesh = box({0, 0, 0}, {1, 1, 1});
  mesh.F(3, 0) = mesh.F(3, 2);
  EXPECT_NE(refusal([&] { validate(mesh, "a.obj"); }).find("triangle 3 uses vertex"), std::string::npos);
  mesh = box({0, 0, 0}, {1, 1, 1});
  mesh.V(6, 2) = std::numeric_limits<double>::infinity();
  EXPECT_NE(refusal([&] { validate(mesh, "a.obj"); }).find("vertex 6 is not finite"), std::string::npos);
  mesh = box({0, 0, 0}, {1, 1, 1});
  mesh.FUV = MatrixX3i::Zero(12, 3);
  EXPECT_NE(refusal([&] { validate(mesh, "a.obj"); }).find("texture coordinate 0"), std::string::npos);
  mesh.FUV = MatrixX3i::Zero(4, 3);
  EXPECT_NE(refusal([&] { validate(mesh, "a.obj"); }), "");
}

TEST(ValidateTriangles, RefusesCoordinatesWhoseAreasWouldOverflow) {
  TriangleMesh mesh = box({0, 0, 0}, {1, 1, 1});
  mesh.V(2, 0) = -1e200;
  EXPECT_NE(refusal([&] { validate(mesh, "a.obj"); }).find("vertex 2 has a coordinate of 1e+200"), std::string::npos);
}

TEST(ValidatePolygons, RefusesFacesOfTooManyCorners) {
  PolygonMesh mesh;
  mesh.V = MatrixX3d::Random(20'000, 3);
  mesh.faces.resize(1);
  for (int v = 0; v < 20'000; ++v) mesh.faces[0].push_back(v);
  EXPECT_NE(refusal([&] { validate(mesh, "p"); }).find("face 0 has 20000 corners"), std::string::npos);
}

TEST(ValidatePolygons, ChecksCornersTextureAndGroups) {
  PolygonMesh mesh;
  mesh.V = MatrixX3d::Random(5, 3);
  mesh.faces = {{0, 1, 2, 3}, {0, 4, 1}};
  EXPECT_EQ(refusal([&] { validate(mesh, "p"); }), "");
  auto broken = mesh;
  broken.faces[1] = {0, 4};
  EXPECT_NE(refusal([&] { validate(broken, "p"); }).find("face 1 has 2 corners"), std::string::npos);
  broken = mesh;
  broken.faces[0] = {0, 1, 2, 0};
  EXPECT_NE(refusal([&] { validate(broken, "p"); }).find("uses vertex 0 twice"), std::string::npos);
  broken = mesh;
  broken.faces[1][2] = 99;
  EXPECT_NE(refusal([&] { validate(broken, "p"); }), "");
  broken = mesh;
  broken.UV = MatrixX2d::Zero(2, 2);
  broken.face_uvs = {{0, 1, 0, 1}, {0, 1, 2}};
  EXPECT_NE(refusal([&] { validate(broken, "p"); }).find("face 1"), std::string::npos);
  broken = mesh;
  broken.face_group = {0, 0};
  EXPECT_NE(refusal([&] { validate(broken, "p"); }).find("group 0"), std::string::npos);
}

TetMesh one_tet() {
  TetMesh mesh;
  mesh.V.resize(4, 3);
  mesh.V << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  mesh.T.resize(1, 4);
  mesh.T << 0, 1, 2, 3;
  mesh.region = VectorXi::Ones(1);
  return mesh;
}

TEST(ValidateTets, NamesInvertedAndFlatTets) {
  EXPECT_EQ(refusal([] { validate(one_tet(), "t"); }), "");
  TetMesh mesh = one_tet();
  std::swap(mesh.T(0, 0), mesh.T(0, 1));
  EXPECT_NE(refusal([&] { validate(mesh, "t"); }).find("tet 0 is inverted"), std::string::npos);
  mesh = one_tet();
  mesh.V(3, 2) = 0;
  EXPECT_NE(refusal([&] { validate(mesh, "t"); }).find("tet 0 is flat"), std::string::npos);
  mesh = one_tet();
  mesh.region.resize(0);
  EXPECT_NE(refusal([&] { validate(mesh, "t"); }).find("region"), std::string::npos);
}

TEST(RequireClosedManifold, RefusesHolesMoebiusStripsFansAndFlippedTriangles) {
  EXPECT_EQ(refusal([] { require_closed_manifold(box({0, 0, 0}, {1, 1, 1}), "s"); }), "");
  TriangleMesh mesh = box({0, 0, 0}, {1, 1, 1});
  mesh.F.conservativeResize(11, 3);
  EXPECT_NE(refusal([&] { require_closed_manifold(mesh, "s"); }).find("1 hole"), std::string::npos);
  EXPECT_NE(refusal([] { require_closed_manifold(test::moebius(8), "s"); }), "");
  mesh = box({0, 0, 0}, {1, 1, 1});
  std::swap(mesh.F(2, 0), mesh.F(2, 1));
  EXPECT_NE(refusal([&] { require_closed_manifold(mesh, "s"); }).find("opposite ways"), std::string::npos);
  EXPECT_NE(refusal([] { require_closed_manifold(TriangleMesh{}, "s"); }), "");
  // Two tetrahedra that share one vertex.
  mesh.V.resize(7, 3);
  mesh.V << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, -1, 0, 0, 0, -1, 0, 0, 0, -1;
  mesh.F.resize(8, 3);
  mesh.F << 1, 2, 3, 0, 3, 2, 0, 1, 3, 0, 2, 1, 4, 6, 5, 0, 5, 6, 0, 6, 4, 0, 4, 5;
  EXPECT_NE(refusal([&] { require_closed_manifold(mesh, "s"); }).find("single vertex"), std::string::npos);
}

TEST(RequireNoSelfIntersections, NamesTheTriangles) {
  TriangleMesh mesh = test::sphere({0, 0, 0}, 1, 3);
  EXPECT_EQ(refusal([&] { require_no_self_intersections(mesh, "s"); }), "");
  mesh.V.row(7) *= -1.5;
  EXPECT_NE(refusal([&] { require_no_self_intersections(mesh, "s"); }).find("intersect"), std::string::npos);
}

TEST(RequireNoDegenerateTriangles, NamesTheTriangle) {
  TriangleMesh mesh = box({0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(refusal([&] { require_no_degenerate_triangles(mesh, "s"); }), "");
  mesh.V.row(7) = mesh.V.row(6);
  EXPECT_NE(refusal([&] { require_no_degenerate_triangles(mesh, "s"); }).find("degenerate"), std::string::npos);
}

}  // namespace
}  // namespace phiz
