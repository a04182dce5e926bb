// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "phiz/anatomy/builtin/mouth/dental_arch.h"
#include "phiz/anatomy/builtin/mouth/teeth.h"
#include "phiz/anatomy/builtin/mouth/tongue.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/topology.h"

namespace phiz {
namespace {

/// Largest distance from a mirrored vertex to the vertex that ought to be its image; vertices come in mirrored pairs.
double asymmetry(const TriangleMesh& mesh) {
  double worst = 0;
  for (Eigen::Index i = 0; i < mesh.V.rows(); ++i) {
    const Eigen::RowVector3d image = mesh.V.row(i).cwiseProduct(Eigen::RowVector3d(-1, 1, 1));
    worst = std::max(worst, (mesh.V.rowwise() - image).rowwise().norm().minCoeff());
  }
  return worst;
}

TEST(Teeth, AreFourteenClosedCrownsPerJaw) {
  const Proportions p;
  for (const TriangleMesh& teeth : {make_upper_teeth(p), make_lower_teeth(p)}) {
    EXPECT_TRUE(is_closed(teeth.F) && is_edge_manifold(teeth.F) && is_oriented(teeth.F));
    EXPECT_EQ(triangle_components(teeth.F).maxCoeff() + 1, 14);
    EXPECT_GT(signed_volume(teeth.V, teeth.F), 0);
    EXPECT_LT(asymmetry(teeth), 1e-12);
  }
}

TEST(Teeth, StayWithinTheLabialOutlineOfTheArch) {
  const Proportions p;
  const TriangleMesh teeth = make_upper_teeth(p);
  for (Eigen::Index i = 0; i < teeth.V.rows(); ++i) {
    const double x = teeth.V(i, 0) / p.arch.half_width;
    const double z = std::max(0.0, teeth.V(i, 2) - p.arch.z0) / p.arch.depth;
    EXPECT_LT(std::hypot(x, z), 1.01) << "vertex " << i;
  }
}

TEST(Teeth, MeetWithAnOverbite) {
  const Proportions p;
  const TriangleMesh upper = make_upper_teeth(p), lower = make_lower_teeth(p);
  EXPECT_NEAR(upper.V.col(1).minCoeff(), p.arch.upper_edge, 1e-4);
  EXPECT_NEAR(lower.V.col(1).maxCoeff(), p.arch.lower_edge, 2e-4);
}

TEST(Gums, AreOneClosedSymmetricBand) {
  const Proportions p;
  for (const TriangleMesh& gums : {make_upper_gums(p), make_lower_gums(p)}) {
    EXPECT_TRUE(is_closed(gums.F) && is_edge_manifold(gums.F) && is_oriented(gums.F));
    EXPECT_EQ(triangle_components(gums.F).maxCoeff(), 0);
    EXPECT_GT(signed_volume(gums.V, gums.F), 0);
    EXPECT_LT(asymmetry(gums), 1e-12);
  }
}

TEST(ArchCurve, RunsBackwardsFromTheIncisors) {
  const ArchCurve arch(0.03, 0.04, 0.03);
  EXPECT_NEAR(arch.point(0).x(), 0, 1e-12);
  EXPECT_NEAR(arch.point(0).y(), 0.07, 1e-12);
  EXPECT_NEAR(arch.point(arch.length()).x(), 0.03, 1e-12);
  EXPECT_NEAR((arch.point(0.021) - arch.point(0.020)).norm(), 0.001, 2e-5);
  EXPECT_NEAR(arch.tangent(0.02).dot(arch.outward(0.02)), 0, 1e-12);
}

TEST(Tongue, ReachesOutOfTheMouthInItsShape) {
  const Proportions p;
  const Part tongue = make_tongue(p);
  EXPECT_TRUE(is_closed(tongue.mesh.F) && is_edge_manifold(tongue.mesh.F) && is_oriented(tongue.mesh.F));
  const double teeth = p.arch.z0 + p.arch.depth;
  EXPECT_LT(tongue.mesh.V.col(2).maxCoeff(), teeth - 0.005);
  const MatrixX3d out = tongue.mesh.V + tongue.shapes.at("tongueOut");
  EXPECT_GT(out.col(2).maxCoeff(), teeth + 0.018);
  EXPECT_GT(signed_volume(out, tongue.mesh.F), 0);
}

}  // namespace
}  // namespace phiz
