// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/geometry/tetrahedralise.h"

#include <gtest/gtest.h>

#include <algorithm>
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
  std::cout << brief_report(quality) << std::endl;
  EXPECT_GT(quality.min_radius_ratio, 0.05);
}

}  // namespace
}  // namespace phiz
