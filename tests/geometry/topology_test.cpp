// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/geometry/topology.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "geometry/shapes.h"

namespace phiz {
namespace {

using test::box;
using test::sphere;

TEST(Topology, ABoxIsAClosedOrientedManifold) {
  const MatrixX3i F = box({0, 0, 0}, {1, 1, 1}).F;
  EXPECT_TRUE(is_closed(F));
  EXPECT_TRUE(is_edge_manifold(F));
  EXPECT_TRUE(is_vertex_manifold(F));
  EXPECT_TRUE(is_oriented(F));
  EXPECT_EQ(edges(F).rows(), 18);
  EXPECT_TRUE(boundary_loops(F).empty());
  EXPECT_EQ(triangle_components(F).maxCoeff(), 0);
}

TEST(Topology, EulerCharacteristics) {
  const auto euler = [](const TriangleMesh& m) { return m.V.rows() - edges(m.F).rows() + m.F.rows(); };
  EXPECT_EQ(euler(sphere({0, 0, 0}, 1, 3)), 2);
  EXPECT_EQ(euler(test::torus(1, 0.3, 12, 8)), 0);
  EXPECT_EQ(euler(test::moebius(9)), 0);
}

TEST(Topology, AMoebiusStripIsManifoldWithOneBoundaryAndNotOriented) {
  const MatrixX3i F = test::moebius(9).F;
  EXPECT_TRUE(is_edge_manifold(F));
  EXPECT_TRUE(is_vertex_manifold(F));
  EXPECT_FALSE(is_closed(F));
  EXPECT_FALSE(is_oriented(F));
}

TEST(Topology, AnOpenFanHasOneLoopAndAThreeBladedFanIsNotManifold) {
  MatrixX3i fan(3, 3);
  fan << 0, 1, 2, 0, 2, 3, 0, 3, 4;
  const auto loops = boundary_loops(fan);
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_EQ(loops[0], (std::vector<int>{0, 1, 2, 3, 4}));
  MatrixX3i blades(3, 3);
  blades << 0, 1, 2, 0, 1, 3, 0, 1, 4;
  EXPECT_FALSE(is_edge_manifold(blades));
  EXPECT_FALSE(is_oriented(blades));
}

TEST(Topology, ABowTieHasTwoLoopsAndIsNotVertexManifold) {
  MatrixX3i tie(2, 3);
  tie << 0, 1, 2, 0, 3, 4;
  EXPECT_FALSE(is_vertex_manifold(tie));
  const auto loops = boundary_loops(tie);
  ASSERT_EQ(loops.size(), 2U);
  EXPECT_EQ(loops[0], (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(loops[1], (std::vector<int>{0, 3, 4}));
}

TEST(Topology, TwoComponentsAreCounted) {
  const MatrixX3i F = box({0, 0, 0}, {1, 1, 1}).F;
  MatrixX3i two(24, 3);
  two << F, F.array() + 8;
  const VectorXi component = triangle_components(two);
  EXPECT_EQ(component.head(12).maxCoeff(), 0);
  EXPECT_EQ(component.tail(12).minCoeff(), 1);
  EXPECT_EQ(component.maxCoeff(), 1);
}

TEST(Topology, EmptyMeshesAreHarmless) {
  const MatrixX3i F(0, 3);
  EXPECT_TRUE(is_closed(F));
  EXPECT_TRUE(is_vertex_manifold(F));
  EXPECT_EQ(edges(F).rows(), 0);
  EXPECT_TRUE(boundary_loops(F).empty());
  EXPECT_EQ(triangle_components(F).size(), 0);
  EXPECT_EQ(boundary_triangles(MatrixX4i(0, 4)).rows(), 0);
}

TEST(Topology, NeighboursAreMutual) {
  const MatrixX3i F = sphere({0, 0, 0}, 1, 2).F;
  const MatrixX3i N = triangle_neighbours(F);
  for (int f = 0; f < F.rows(); ++f)
    for (int k = 0; k < 3; ++k) {
      ASSERT_GE(N(f, k), 0);
      EXPECT_TRUE((N.row(N(f, k)).array() == f).any());
    }
}

/// Two positive tets that share the face 1 2 3.
TetMesh two_tets() {
  TetMesh mesh;
  mesh.V.resize(5, 3);
  mesh.V << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1;
  mesh.T.resize(2, 4);
  mesh.T << 0, 1, 2, 3, 4, 2, 1, 3;
  mesh.region.resize(2);
  mesh.region << 1, 2;
  return mesh;
}

TEST(Topology, FacesOfTetsPointOutward) {
  const TetMesh mesh = two_tets();
  const MatrixX3i F = boundary_triangles(mesh.T);
  EXPECT_EQ(F.rows(), 6);
  EXPECT_TRUE(is_closed(F));
  EXPECT_TRUE(is_oriented(F));
  const Vector3d centre = mesh.V.colwise().mean();
  for (int f = 0; f < F.rows(); ++f) {
    const Vector3d a = mesh.V.row(F(f, 0)), b = mesh.V.row(F(f, 1)), c = mesh.V.row(F(f, 2));
    EXPECT_GT((b - a).cross(c - a).dot(a - centre), 0);
  }
  EXPECT_EQ(tet_components(mesh.T).maxCoeff(), 0);
  EXPECT_EQ(tet_edges(mesh.T).rows(), 9);
}

TEST(Topology, RegionFacesListEachInterfaceOnce) {
  const TetMesh mesh = two_tets();
  const RegionFaces faces = region_faces(mesh);
  EXPECT_EQ(faces.F.rows(), 7);
  int interfaces = 0;
  for (int f = 0; f < faces.F.rows(); ++f)
    if (faces.outer[f] != RegionFaces::no_region) {
      ++interfaces;
      EXPECT_EQ(faces.inner[f], 1);
      EXPECT_EQ(faces.outer[f], 2);
      EXPECT_EQ(faces.tet[f], 0);
    }
  EXPECT_EQ(interfaces, 1);
  EXPECT_EQ(region_boundary(mesh, 1).rows(), 4);
  EXPECT_TRUE(is_closed(region_boundary(mesh, 2)));
}

TEST(Topology, UnusedVerticesAreRemoved) {
  TriangleMesh mesh = box({0, 0, 0}, {1, 1, 1});
  const CompactMesh half = remove_unused_vertices(mesh.V, mesh.F.topRows(2));
  EXPECT_EQ(half.mesh.V.rows(), 4);
  for (int f = 0; f < 2; ++f)
    for (int k = 0; k < 3; ++k) EXPECT_EQ(half.kept[half.mesh.F(f, k)], mesh.F(f, k));
}

}  // namespace
}  // namespace phiz
