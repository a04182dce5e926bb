// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "phiz/anatomy/builtin/mouth/dental_arch.h"
#include "phiz/anatomy/builtin/mouth/loft.h"
#include "phiz/anatomy/builtin/mouth/teeth.h"
#include "phiz/anatomy/builtin/mouth/tongue.h"
#include "phiz/anatomy/builtin/skin/identity.h"
#include "phiz/geometry/spatial_query.h"
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

/// Pairs of triangles of two surfaces that pass through one another.
std::size_t crossings(const TriangleMesh& a, const TriangleMesh& b) {
  const std::vector<TriangleMesh> both{a, b};
  return self_intersections(joined(both)).size() - self_intersections(a).size() - self_intersections(b).size();
}

/// The vertices of one tooth: component `number` of the surface.
MatrixX3d tooth(const TriangleMesh& teeth, int number) {
  const VectorXi component = triangle_components(teeth.F);
  std::set<int> own;
  for (Eigen::Index f = 0; f < teeth.F.rows(); ++f)
    if (component[f] == number)
      for (int k = 0; k < 3; ++k) own.insert(teeth.F(f, k));
  return teeth.V(std::vector<int>(own.begin(), own.end()), Eigen::all);
}

TEST(Teeth, StandBesideOneAnotherAndMeetWithoutCrossing) {
  for (const int person : {-1, 1, 2, 3, 4, 5}) {
    const Proportions p = personalise(Proportions{}, person < 0 ? IdentityParameters{} : random_identity(person));
    const TriangleMesh upper = make_upper_teeth(p), lower = make_lower_teeth(p);
    EXPECT_EQ(self_intersections(upper).size(), 0U) << "person " << person;
    EXPECT_EQ(self_intersections(lower).size(), 0U) << "person " << person;
    EXPECT_EQ(crossings(upper, lower), 0U) << "person " << person;
  }
}

TEST(Teeth, OfTheUpperJawStandInFrontByAnOverjetOfTwoMillimetres) {
  const Proportions p;
  const MatrixX3d upper = tooth(make_upper_teeth(p), 0), lower = tooth(make_lower_teeth(p), 0);
  const auto edge_front = [](const MatrixX3d& V, double from, double to) {
    double z = 0;
    for (Eigen::Index v = 0; v < V.rows(); ++v)
      if (V(v, 1) > from && V(v, 1) < to) z = std::max(z, V(v, 2));
    return z;
  };
  const double jet = edge_front(upper, p.arch.upper_edge - 1e-3, p.arch.upper_edge + 1e-3) -
                     edge_front(lower, p.arch.lower_edge - 1e-3, p.arch.lower_edge + 1e-3);
  EXPECT_GT(jet, 0.0015);
  EXPECT_LT(jet, 0.0035);
}

TEST(Teeth, AreNarrowerAtTheNeckAndAtTheEdgeThanBetween) {
  const Proportions p;
  for (int number = 0; number < 14; ++number) {
    const MatrixX3d V = tooth(make_upper_teeth(p), number);
    const double edge = V.col(1).minCoeff(), root = V.col(1).maxCoeff();
    const auto width = [&](double from, double to) {
      Eigen::AlignedBox2d box;
      for (Eigen::Index v = 0; v < V.rows(); ++v)
        if (const double t = (V(v, 1) - root) / (edge - root); t > from && t < to)
          box.extend(Vector2d(V(v, 0), V(v, 2)));
      return box.diagonal().norm();
    };
    EXPECT_LT(width(0, 0.3), 0.97 * width(0.3, 0.9)) << "tooth " << number;
    EXPECT_LT(width(0.97, 1.01), 0.97 * width(0.3, 0.9)) << "tooth " << number;
  }
}

TEST(Gums, RiseBetweenTheTeethAndCoverTheirNecks) {
  const Proportions p;
  const TriangleMesh gums = make_upper_gums(p), teeth = make_upper_teeth(p);
  const SurfaceQuery query(gums);
  for (int number = 0; number < 14; ++number) {
    const MatrixX3d V = tooth(teeth, number);
    const double root = V.col(1).maxCoeff();
    for (Eigen::Index v = 0; v < V.rows(); ++v)
      if (V(v, 1) > root - 1e-3) {
        EXPECT_LT(query.signed_distance(V.row(v)), 0) << "root of tooth " << number;
      }
  }
  // The papilla between the central incisors reaches farther down than the gum over the middle of their crowns.
  const auto lowest = [&](double from, double to) {
    double y = 0;
    for (Eigen::Index v = 0; v < gums.V.rows(); ++v)
      if (gums.V(v, 2) > p.arch.z0 + p.arch.depth - 0.003 && std::abs(gums.V(v, 0)) > from &&
          std::abs(gums.V(v, 0)) < to)
        y = std::min(y, gums.V(v, 1));
    return y;
  };
  EXPECT_LT(lowest(0, 0.0006), lowest(0.0035, 0.005) - 0.003);
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

TEST(Tongue, LiesBetweenTheTeethWithItsTipBehindTheLowerIncisors) {
  for (const int person : {-1, 1, 2, 3, 4, 5}) {
    const Proportions p = personalise(Proportions{}, person < 0 ? IdentityParameters{} : random_identity(person));
    const Part tongue = make_tongue(p);
    TriangleMesh out = tongue.mesh;
    out.V += tongue.shapes.at("tongueOut");
    EXPECT_EQ(crossings(tongue.mesh, make_upper_teeth(p)), 0U) << "person " << person;
    EXPECT_EQ(crossings(tongue.mesh, make_lower_teeth(p)), 0U) << "person " << person;
    EXPECT_EQ(crossings(out, make_lower_teeth(p)), 0U) << "person " << person;
    EXPECT_EQ(self_intersections(tongue.mesh).size(), 0U) << "person " << person;
    EXPECT_EQ(self_intersections(out).size(), 0U) << "person " << person;
    Eigen::Index tip = 0;
    tongue.mesh.V.col(2).maxCoeff(&tip);
    EXPECT_LT(tongue.mesh.V(tip, 1), p.arch.lower_edge) << "person " << person;
    EXPECT_GT(tongue.mesh.V(tip, 1), p.arch.lower_gum) << "person " << person;
  }
}

}  // namespace
}  // namespace phiz
