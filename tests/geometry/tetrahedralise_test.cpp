// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/geometry/tetrahedralise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "geometry/shapes.h"
#include "phiz/core/error.h"
#include "phiz/geometry/operators.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/topology.h"
#include "phiz/geometry/validate.h"

namespace phiz {
namespace {

using test::box;
using test::sphere;

std::set<std::array<int, 3>> sorted_faces(const MatrixX3i& F) {
  std::set<std::array<int, 3>> faces;
  for (Eigen::Index f = 0; f < F.rows(); ++f) {
    std::array<int, 3> face{F(f, 0), F(f, 1), F(f, 2)};
    std::sort(face.begin(), face.end());
    faces.insert(face);
  }
  return faces;
}

double region_volume(const TetMesh& mesh, int region) {
  const VectorXd volumes = tet_volumes(mesh.V, mesh.T);
  double sum = 0;
  for (Eigen::Index t = 0; t < volumes.size(); ++t)
    if (mesh.region[t] == region) sum += volumes[t];
  return sum;
}

TEST(Tetrahedralise, ABoxIsFilledAndKeepsItsTriangles) {
  const TriangleMesh surface = box({0, 0, 0}, {1, 2, 3});
  const RegionSurface region{"box", surface, 7, false, 0.4};
  const TetMesh mesh = tetrahedralise(std::span(&region, 1));
  validate(mesh, "mesh");
  EXPECT_EQ(mesh.V.topRows(8), surface.V);
  EXPECT_EQ(sorted_faces(boundary_triangles(mesh.T)), sorted_faces(surface.F));
  EXPECT_NEAR(region_volume(mesh, 7), 6.0, 1e-12);
}

TEST(Tetrahedralise, NestedSpheresBecomeRegionsWithExactInterfaces) {
  const std::vector<RegionSurface> surfaces{{"skin", sphere({0, 0, 0}, 0.1, 4), 1, false, 0.012},
                                            {"bone", sphere({0.02, 0, 0}, 0.05, 3), 2, false, 0},
                                            {"tooth", sphere({-0.06, 0, 0}, 0.02, 3), 3, false, 0},
                                            {"marrow", sphere({0.02, 0, 0}, 0.02, 2), 4, false, 0}};
  const TetMesh mesh = tetrahedralise(surfaces);
  std::vector<double> inside;
  Eigen::Index row = 0;
  for (const auto& s : surfaces) {
    EXPECT_EQ(mesh.V.middleRows(row, s.surface.V.rows()), s.surface.V);
    row += s.surface.V.rows();
    inside.push_back(signed_volume(s.surface.V, s.surface.F));
  }
  EXPECT_NEAR(region_volume(mesh, 1), inside[0] - inside[1] - inside[2], 1e-15);
  EXPECT_NEAR(region_volume(mesh, 2), inside[1] - inside[3], 1e-15);
  EXPECT_NEAR(region_volume(mesh, 3), inside[2], 1e-15);
  EXPECT_NEAR(region_volume(mesh, 4), inside[3], 1e-15);
  const RegionFaces faces = region_faces(mesh);
  Eigen::Index triangles = 0;
  for (const auto& s : surfaces) triangles += s.surface.F.rows();
  EXPECT_EQ(faces.F.rows(), triangles);
  const TetQuality quality = tet_quality(mesh);
  EXPECT_GT(quality.min_radius_ratio, 0.05);
  EXPECT_GT(quality.min_dihedral, 6);
}

TEST(Tetrahedralise, AHoleStaysEmptyAndItsSurfaceBecomesABoundary) {
  const std::vector<RegionSurface> surfaces{{"flesh", sphere({0, 0, 0}, 0.1, 3), 1, false, 0.03},
                                            {"socket", sphere({0.02, 0, 0.03}, 0.03, 2), 0, true, 0}};
  const TetMesh mesh = tetrahedralise(surfaces);
  EXPECT_TRUE((mesh.region.array() == 1).all());
  EXPECT_EQ(boundary_triangles(mesh.T).rows(), surfaces[0].surface.F.rows() + surfaces[1].surface.F.rows());
  EXPECT_NEAR(region_volume(mesh, 1),
              signed_volume(surfaces[0].surface.V, surfaces[0].surface.F) -
                  signed_volume(surfaces[1].surface.V, surfaces[1].surface.F),
              1e-15);
}

TEST(Tetrahedralise, ASurfaceMayHaveSeveralPiecesAndVoids) {
  const auto join = [](const TriangleMesh& a, const TriangleMesh& b) {
    TriangleMesh both;
    both.V.resize(a.V.rows() + b.V.rows(), 3);
    both.V << a.V, b.V;
    both.F.resize(a.F.rows() + b.F.rows(), 3);
    both.F << a.F, b.F.array() + static_cast<int>(a.V.rows());
    return both;
  };
  TriangleMesh cavity = box({0.06, 0.02, 0.02}, {0.07, 0.03, 0.03});
  cavity.F = cavity.F.rowwise().reverse().eval();
  const TriangleMesh teeth =
      join(box({0.01, 0.01, 0.01}, {0.03, 0.04, 0.04}), box({0.05, 0.01, 0.01}, {0.08, 0.04, 0.04}));
  const std::vector<RegionSurface> surfaces{{"flesh", box({0, 0, 0}, {0.1, 0.05, 0.05}), 1, false, 0},
                                            {"teeth", join(teeth, cavity), 2, false, 0}};
  const TetMesh mesh = tetrahedralise(surfaces);
  EXPECT_NEAR(region_volume(mesh, 2), 0.05 * 9e-4 - 1e-6, 1e-15);
  EXPECT_NEAR(region_volume(mesh, 1), 0.1 * 25e-4 - 0.05 * 9e-4, 1e-15);
}

TEST(Tetrahedralise, ThinGapsAreKept) {
  // Two plates a tenth of a millimetre apart inside of a block.
  const std::vector<RegionSurface> surfaces{{"block", box({0, 0, 0}, {0.1, 0.1, 0.1}), 1, false, 0},
                                            {"lower", box({0.02, 0.02, 0.02}, {0.08, 0.05, 0.08}), 2, false, 0},
                                            {"upper", box({0.02, 0.0501, 0.02}, {0.08, 0.08, 0.08}), 3, false, 0}};
  const TetMesh mesh = tetrahedralise(surfaces);
  EXPECT_NEAR(region_volume(mesh, 2), 0.06 * 0.03 * 0.06, 1e-15);
  EXPECT_NEAR(region_volume(mesh, 1), 1e-3 - 0.06 * 0.06 * (0.03 + 0.0299), 1e-12);
}

TEST(Tetrahedralise, OnlySurfacesWithGiveMove) {
  // Sheets 3 mm apart with edges of up to 15 mm.
  std::vector<RegionSurface> surfaces{{"skin", sphere({0, 0, 0}, 0.1, 3)},
                                      {"bone", sphere({0.002, 0, 0}, 0.095, 3), 2}};
  const Eigen::Index skin = surfaces[0].surface.V.rows(), bone = surfaces[1].surface.V.rows();
  const TetMesh stiff = tetrahedralise(surfaces);
  EXPECT_EQ(stiff.V.middleRows(skin, bone), surfaces[1].surface.V);
  surfaces[1].give = VectorXd::Constant(bone, 0.001);
  const TetMesh giving = tetrahedralise(surfaces);
  EXPECT_EQ(giving.V.topRows(skin), surfaces[0].surface.V);
  const double farthest = (giving.V.middleRows(skin, bone) - surfaces[1].surface.V).rowwise().norm().maxCoeff();
  EXPECT_GT(farthest, 1e-5);
  EXPECT_LE(farthest, 0.001 + 1e-12);
  EXPECT_GE(tet_quality(giving).min_dihedral, tet_quality(stiff).min_dihedral);
  EXPECT_EQ(sorted_faces(region_faces(giving).F), sorted_faces(region_faces(stiff).F));
  surfaces[1].give = VectorXd::Constant(1, 0.001);
  EXPECT_THROW(tetrahedralise(surfaces), Error);
}

TEST(Tetrahedralise, SizingFunctionRefinesWhereItAsks) {
  const RegionSurface skin{"skin", sphere({0, 0, 0}, 0.1, 3), 1, false, 0};
  TetrahedraliseOptions options;
  const auto coarse = tetrahedralise(std::span(&skin, 1), options).T.rows();
  options.sizing = [](const Vector3d& p) { return p[0] > 0 ? 0.01 : 0.0; };
  const TetMesh mesh = tetrahedralise(std::span(&skin, 1), options);
  EXPECT_GT(mesh.T.rows(), 3 * coarse);
  Eigen::Index right = 0;
  for (Eigen::Index t = 0; t < mesh.T.rows(); ++t) {
    const Vector3d p[4] = {mesh.V.row(mesh.T(t, 0)), mesh.V.row(mesh.T(t, 1)), mesh.V.row(mesh.T(t, 2)),
                           mesh.V.row(mesh.T(t, 3))};
    if (((p[0] + p[1] + p[2] + p[3]) / 4)[0] > 0) ++right;
  }
  EXPECT_GT(right, 0.75 * static_cast<double>(mesh.T.rows()));
}

TEST(Tetrahedralise, ReachesATargetCount) {
  const std::vector<RegionSurface> surfaces{{"skin", sphere({0, 0, 0}, 0.1, 4), 1, false, 0},
                                            {"bone", sphere({0, 0, 0}, 0.06, 3), 2, false, 0}};
  TetrahedraliseOptions options;
  options.target_tets = 30000;
  EXPECT_NEAR(static_cast<double>(tetrahedralise(surfaces, options).T.rows()), 30000, 1500);
}

TEST(Tetrahedralise, IsTheSameEveryTime) {
  const RegionSurface skin{"skin", test::torus(0.1, 0.04, 24, 12), 1, false, 0.04};
  const TetMesh first = tetrahedralise(std::span(&skin, 1));
  const TetMesh second = tetrahedralise(std::span(&skin, 1));
  EXPECT_EQ(first.V, second.V);
  EXPECT_EQ(first.T, second.T);
}

/// The message with which the surfaces are refused.
std::string refusal(const std::vector<RegionSurface>& surfaces) {
  try {
    tetrahedralise(surfaces);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    return error.what();
  }
  return "";
}

TEST(Tetrahedralise, RefusesBadSurfacesByName) {
  EXPECT_NE(refusal({}), "");
  TriangleMesh open = box({0, 0, 0}, {1, 1, 1});
  open.F.conservativeResize(10, 3);
  EXPECT_NE(refusal({{"jaw", open}}).find("jaw"), std::string::npos);
  TriangleMesh inward = box({0, 0, 0}, {1, 1, 1});
  inward.F = inward.F.rowwise().reverse().eval();
  EXPECT_NE(refusal({{"jaw", inward}}).find("faces inward"), std::string::npos);
  TriangleMesh lone = box({0, 0, 0}, {1, 1, 1});
  lone.V.conservativeResize(9, 3);
  lone.V.row(8).setZero();
  EXPECT_NE(refusal({{"jaw", lone}}).find("belong to no triangle"), std::string::npos);
  const std::string crossing =
      refusal({{"skin", box({0, 0, 0}, {1, 1, 1})}, {"skull", box({0.5, 0.5, 0.5}, {2, 2, 2})}});
  EXPECT_NE(crossing.find("of skin intersects triangle"), std::string::npos);
  EXPECT_NE(crossing.find("of skull"), std::string::npos);
  EXPECT_NE(refusal({{"a", box({0, 0, 0}, {1, 1, 1})}, {"b", box({1, 0, 0}, {2, 1, 1})}}), "");
}

TEST(TetQuality, OfARegularTetIsOne) {
  const Vector3d a(1, 1, 1), b(1, -1, -1), c(-1, 1, -1), d(-1, -1, 1);
  EXPECT_NEAR(std::abs(radius_ratio(a, b, c, d)), 1, 1e-14);
  EXPECT_LT(radius_ratio(a, b, c, d) * radius_ratio(b, a, c, d), 0);
  const auto [low, high] = dihedral_range(a, b, c, d);
  EXPECT_NEAR(low, 70.528779365509308, 1e-10);
  EXPECT_NEAR(high, low, 1e-10);
  EXPECT_EQ(radius_ratio(a, b, c, 0.5 * (a + b)), 0);
}

TEST(SmoothInterior, RaisesTheWorstTetAndMovesOnlyFreeVertices) {
  const TriangleMesh surface = sphere({0, 0, 0}, 1, 3);
  const RegionSurface skin{"skin", surface, 1, false, 0.3};
  TetrahedraliseOptions options;
  options.smoothing_passes = 0;
  TetMesh mesh = tetrahedralise(std::span(&skin, 1), options);
  const TetQuality before = tet_quality(mesh);
  std::vector<char> fixed(static_cast<std::size_t>(mesh.V.rows()), 0);
  std::fill_n(fixed.begin(), surface.V.rows(), char{1});
  EXPECT_GT(smooth_interior(mesh, fixed, 5), 0);
  const TetQuality after = tet_quality(mesh);
  EXPECT_GE(after.min_radius_ratio, before.min_radius_ratio);
  const auto poor = [](const TetQuality& q) {
    return std::accumulate(q.radius_ratio_histogram.begin(), q.radius_ratio_histogram.begin() + 4, 0);
  };
  EXPECT_LT(poor(after), poor(before) / 2);
  EXPECT_NEAR(after.total_volume, before.total_volume, 1e-12);
  EXPECT_EQ(mesh.V.topRows(surface.V.rows()), surface.V);
}

}  // namespace
}  // namespace phiz
