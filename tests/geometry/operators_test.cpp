// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/geometry/operators.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "geometry/shapes.h"
#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/tetrahedralise.h"

namespace phiz {
namespace {

const TetMesh& ball() {
  static const TetMesh mesh = [] {
    const RegionSurface skin{"skin", test::sphere({0, 0, 0}, 0.1, 3), 1, false, 0.03};
    return tetrahedralise(std::span(&skin, 1));
  }();
  return mesh;
}

const Matrix3d A = (Matrix3d() << 1.1, 0.3, -0.2, 0.05, 0.8, 0.4, -0.3, 0.1, 1.2).finished();

TEST(TetOperators, DeformationGradientOfAnAffineMapIsThatMap) {
  const TetMesh& mesh = ball();
  const TetRest rest = tet_rest(mesh.V, mesh.T);
  const MatrixX3d moved = (mesh.V * A.transpose()).rowwise() + Vector3d(1, 2, 3).transpose();
  for (const Matrix3d& F : deformation_gradients(moved, mesh.T, rest)) EXPECT_LE((F - A).norm(), 1e-10);
}

TEST(TetOperators, GradientOfALinearFunctionIsConstant) {
  const TetMesh& mesh = ball();
  const VectorXd u = (mesh.V * Vector3d(1, -2, 3)).array() + 5;
  const VectorXd g = tet_gradient_operator(mesh.V, mesh.T) * u;
  for (Eigen::Index t = 0; t < mesh.T.rows(); ++t) EXPECT_LE((g.segment<3>(3 * t) - Vector3d(1, -2, 3)).norm(), 1e-9);
}

TEST(TetOperators, LaplacianIsTheWeightedSquareOfTheGradient) {
  const TetMesh& mesh = ball();
  const SparseMatrixd L = tet_laplacian(mesh.V, mesh.T);
  const SparseMatrixd G = tet_gradient_operator(mesh.V, mesh.T);
  const VectorXd volumes = tet_volumes(mesh.V, mesh.T);
  VectorXd weights(3 * volumes.size());
  for (Eigen::Index t = 0; t < volumes.size(); ++t) weights.segment<3>(3 * t).setConstant(volumes[t]);
  const SparseMatrixd product = SparseMatrixd(G.transpose()) * weights.asDiagonal() * G;
  EXPECT_LE((L - product).norm(), 1e-12 * L.norm());
  EXPECT_LE((L * VectorXd::Ones(L.cols())).norm(), 1e-12 * L.norm());
  const VectorXd u = mesh.V.col(0);
  EXPECT_NEAR(u.dot(L * u), volumes.sum(), 1e-12);
}

TEST(TetOperators, MassSumsToDensityTimesVolume) {
  const TetMesh& mesh = ball();
  const double volume = signed_volume(mesh.V, test::sphere({0, 0, 0}, 0.1, 3).F);
  EXPECT_NEAR(lumped_tet_mass(mesh.V, mesh.T, 1000).sum(), 1000 * volume, 1e-10);
  EXPECT_GT(lumped_tet_mass(mesh.V, mesh.T).minCoeff(), 0);
}

TEST(TetOperators, RestRefusesAnInvertedTetByNumber) {
  TetMesh mesh = ball();
  std::swap(mesh.T(17, 0), mesh.T(17, 1));
  try {
    tet_rest(mesh.V, mesh.T);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("tet 17"), std::string::npos);
  }
}

TEST(TetOperators, AreTheSameBitsForAnyNumberOfThreads) {
  const TetMesh& mesh = ball();
  const TetRest rest = tet_rest(mesh.V, mesh.T);
  const auto parallel = deformation_gradients(1.1 * mesh.V, mesh.T, rest);
  const ThreadLimit limit(1);
  EXPECT_EQ(parallel, deformation_gradients(1.1 * mesh.V, mesh.T, rest));
}

TEST(TriangleOperators, CotangentLaplacianOfLinearFunctionsOnAPlaneVanishesInside) {
  MatrixX3d V(5, 3);
  V << 0, 0, 0, 2, 0, 0, 2, 1.5, 0, 0, 1, 0, 0.9, 0.6, 0;
  MatrixX3i F(4, 3);
  F << 0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4;
  const SparseMatrixd L = cotangent_laplacian(V, F);
  EXPECT_NEAR((L * V)(4, 0), 0, 1e-14);
  EXPECT_NEAR((L * V)(4, 1), 0, 1e-14);
  const double area = triangle_areas(V, F).sum();
  EXPECT_NEAR(V.col(0).dot(L * V.col(0)), area, 1e-13);
  EXPECT_NEAR(lumped_triangle_mass(V, F).sum(), area, 1e-14);
}

TEST(TriangleOperators, WeightsScaleTheTrianglesOfACotangentLaplacian) {
  MatrixX3d V(4, 3);
  V << 0, 0, 0, 2, 0, 0, 2, 1.5, 0, 0, 1, 0.4;
  MatrixX3i F(2, 3);
  F << 0, 1, 2, 0, 2, 3;
  const SparseMatrixd expected =
      3 * cotangent_laplacian(V, F.topRows(1)) + 0.5 * cotangent_laplacian(V, F.bottomRows(1));
  EXPECT_LE((cotangent_laplacian(V, F, Eigen::Vector2d(3, 0.5)) - expected).norm(), 1e-14);
}

TEST(TriangleOperators, DegenerateTrianglesAddNothing) {
  MatrixX3d V(3, 3);
  V << 0, 0, 0, 1, 0, 0, 2, 0, 0;
  MatrixX3i F(1, 3);
  F << 0, 1, 2;
  EXPECT_EQ(cotangent_laplacian(V, F).norm(), 0);
}

TEST(Barycentric, RestoresPointsOfTrianglesAndTets) {
  const Vector3d a(0, 0, 0), b(1, 0.2, 0), c(0.3, 1, 0.5), d(0.1, 0.2, 1);
  const Vector3d w(0.2, 0.5, 0.3);
  EXPECT_LE((barycentric(w[0] * a + w[1] * b + w[2] * c, a, b, c) - w).norm(), 1e-14);
  const Vector3d off = (b - a).cross(c - a);
  EXPECT_LE((barycentric(w[0] * a + w[1] * b + w[2] * c + off, a, b, c) - w).norm(), 1e-14);
  const Eigen::Vector4d u(0.1, 0.2, 0.3, 0.4);
  EXPECT_LE((barycentric(u[0] * a + u[1] * b + u[2] * c + u[3] * d, a, b, c, d) - u).norm(), 1e-14);
}

TEST(Barycentric, DegenerateElementsGiveFiniteWeightsThatSumToOne) {
  const Vector3d a(0, 0, 0), b(1, 0, 0), c(3, 0, 0);
  const Vector3d w = barycentric({2, 5, 0}, a, b, c);
  EXPECT_NEAR(w.sum(), 1, 1e-15);
  EXPECT_LE((w[0] * a + w[1] * b + w[2] * c - Vector3d(2, 0, 0)).norm(), 1e-14);
  EXPECT_NEAR(barycentric({2, 5, 0}, a, a, a).sum(), 1, 1e-15);
  EXPECT_NEAR(barycentric({1, 1, 1}, a, b, c, {4, 0, 0}).sum(), 1, 1e-15);
}

}  // namespace
}  // namespace phiz
