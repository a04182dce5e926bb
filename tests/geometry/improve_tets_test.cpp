// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/geometry/improve_tets.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "geometry/shapes.h"
#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/core/random.h"
#include "phiz/geometry/operators.h"
#include "phiz/geometry/tet_operations.h"
#include "phiz/geometry/tetrahedralise.h"
#include "phiz/geometry/topology.h"
#include "phiz/geometry/validate.h"

namespace phiz {
namespace {

using test::sphere;

std::set<std::array<int, 3>> surface_of(const TetMesh& mesh) {
  const RegionFaces faces = region_faces(mesh);
  std::set<std::array<int, 3>> sorted;
  for (Eigen::Index f = 0; f < faces.F.rows(); ++f) {
    std::array<int, 3> face{faces.F(f, 0), faces.F(f, 1), faces.F(f, 2)};
    std::sort(face.begin(), face.end());
    sorted.insert(face);
  }
  return sorted;
}

double volume(const TetMesh& mesh, int region) {
  const VectorXd volumes = tet_volumes(mesh.V, mesh.T);
  double sum = 0;
  for (Eigen::Index t = 0; t < volumes.size(); ++t) sum += mesh.region[t] == region ? volumes[t] : 0.0;
  return sum;
}

/// A ball of bone in a ball of flesh as TetGen leaves it, with every inner vertex then pushed about until the mesh is
/// full of slivers. The vertices of the surfaces come first.
struct Nasty {
  TetMesh mesh;
  Eigen::Index surface;
};
Nasty nasty_balls(double bone_radius = 0.06) {
  const std::vector<RegionSurface> surfaces{{"flesh", sphere({0, 0, 0}, 0.1, 3), 1, false, 0.02},
                                            {"bone", sphere({0.01, 0, 0}, bone_radius, 3), 2, false, 0.02}};
  TetrahedraliseOptions options;
  options.smoothing_passes = 0;
  options.improve_below = 0;
  Nasty nasty{tetrahedralise(surfaces, options), surfaces[0].surface.V.rows() + surfaces[1].surface.V.rows()};
  TetMesh& mesh = nasty.mesh;
  Random random(5);
  for (Eigen::Index v = nasty.surface; v < mesh.V.rows(); ++v)
    for (double step = 0.02; step > 1e-4; step *= 0.8) {
      const Eigen::RowVector3d before = mesh.V.row(v);
      mesh.V.row(v) += step * Eigen::RowVector3d(random.normal(), random.normal(), random.normal());
      const double smallest = tet_volumes(mesh.V, mesh.T).minCoeff();
      if (smallest > 1e-12) break;
      mesh.V.row(v) = before;
    }
  validate(mesh, "nasty");
  return nasty;
}

TEST(ImproveTets, SliversGoAndSurfacesStay) {
  Nasty nasty = nasty_balls();
  const TetMesh before = nasty.mesh;
  const TetQuality poor = tet_quality(before);
  ASSERT_LT(poor.min_dihedral, 1);
  ImproveOptions options;
  options.target = 15;
  options.insert_below = 10;
  const ImproveSummary summary = improve_tets(nasty.mesh, options);
  validate(nasty.mesh, "better");
  const TetQuality good = tet_quality(nasty.mesh);
  EXPECT_GE(good.min_dihedral, 10) << brief_report(summary);
  EXPECT_LE(good.max_dihedral, 170);
  EXPECT_LT(summary.below_after, summary.below_before / 4);
  EXPECT_NEAR(summary.worst_after, std::min(good.min_dihedral, 180 - good.max_dihedral), 1e-6);
  EXPECT_EQ(nasty.mesh.V.topRows(nasty.surface), before.V.topRows(nasty.surface));
  EXPECT_EQ(surface_of(nasty.mesh), surface_of(before));
  for (const int region : {1, 2}) EXPECT_NEAR(volume(nasty.mesh, region), volume(before, region), 1e-15);
  EXPECT_EQ(summary.largest_surface_move, 0);
}

TEST(ImproveTets, EveryVertexIsUsed) {
  Nasty nasty = nasty_balls();
  improve_tets(nasty.mesh);
  std::vector<char> used(static_cast<std::size_t>(nasty.mesh.V.rows()), 0);
  for (Eigen::Index t = 0; t < nasty.mesh.T.rows(); ++t)
    for (int k = 0; k < 4; ++k) used[static_cast<std::size_t>(nasty.mesh.T(t, k))] = 1;
  EXPECT_EQ(std::count(used.begin(), used.end(), 0), 0);
}

TEST(ImproveTets, WithoutInsertionsNoVertexIsAdded) {
  Nasty nasty = nasty_balls();
  const Eigen::Index vertices = nasty.mesh.V.rows();
  ImproveOptions options;
  options.insert_below = 0;
  const ImproveSummary summary = improve_tets(nasty.mesh, options);
  EXPECT_EQ(summary.insertions, 0);
  EXPECT_LE(nasty.mesh.V.rows(), vertices);
  EXPECT_GT(summary.worst_after, summary.worst_before);
}

TEST(ImproveTets, DoesNotDependOnTheNumberOfThreads) {
  const Nasty nasty = nasty_balls();
  TetMesh one = nasty.mesh, all = nasty.mesh;
  {
    const ThreadLimit limit(1);
    improve_tets(one);
  }
  improve_tets(all);
  EXPECT_EQ(one.V, all.V);
  EXPECT_EQ(one.T, all.T);
  EXPECT_EQ(one.region, all.region);
}

TEST(ImproveTets, LeavesAGoodMeshAlone) {
  Nasty nasty = nasty_balls();
  ImproveOptions options;
  options.target = 0;
  const TetMesh before = nasty.mesh;
  const ImproveSummary summary = improve_tets(nasty.mesh, options);
  EXPECT_EQ(nasty.mesh.V, before.V);
  EXPECT_EQ(nasty.mesh.T, before.T);
  EXPECT_EQ(summary.moves + summary.flips + summary.contractions + summary.insertions, 0);
}

/// Two sheets 0.3 mm apart with edges of about 13 mm: no tets between them have good angles while they stay.
TEST(ImproveTets, GiveMovesSurfacesNoFartherThanAllowed) {
  Nasty stiff = nasty_balls(0.0888), giving = stiff;
  ImproveOptions options;
  const ImproveSummary kept = improve_tets(stiff.mesh, options);
  options.give = VectorXd::Zero(giving.mesh.V.rows());
  const Eigen::Index skin = giving.surface / 2;
  options.give.segment(skin, giving.surface - skin).setConstant(0.0015);
  const TetMesh before = giving.mesh;
  const ImproveSummary moved = improve_tets(giving.mesh, options);
  validate(giving.mesh, "giving");
  EXPECT_GT(moved.worst_after, kept.worst_after);
  EXPECT_EQ(giving.mesh.V.topRows(skin), before.V.topRows(skin));
  EXPECT_EQ(surface_of(giving.mesh), surface_of(before));
  const double farthest = (giving.mesh.V - before.V.topRows(giving.mesh.V.rows()))
                              .middleRows(skin, giving.surface - skin)
                              .rowwise()
                              .norm()
                              .maxCoeff();
  EXPECT_NEAR(farthest, moved.largest_surface_move, 1e-15);
  EXPECT_GT(farthest, 1e-4);
  EXPECT_LE(farthest, 0.0015 + 1e-12);
}

TEST(SmoothTets, KeepsRowsAndTurnsInvertedTetsBack) {
  Nasty nasty = nasty_balls();
  TetMesh& mesh = nasty.mesh;
  // An inner vertex through a face of one of its tets.
  for (Eigen::Index t = 0; t < mesh.T.rows(); ++t)
    if (mesh.T(t, 0) == nasty.surface) {
      const Eigen::RowVector3d opposite =
          mesh.V({mesh.T(t, 1), mesh.T(t, 2), mesh.T(t, 3)}, Eigen::all).colwise().mean();
      mesh.V.row(nasty.surface) += 1.2 * (opposite - mesh.V.row(nasty.surface));
      break;
    }
  ASSERT_LE(tet_volumes(mesh.V, mesh.T).minCoeff(), 0);
  const TetMesh before = mesh;
  const double worst = smooth_tets(mesh, {});
  EXPECT_GT(worst, 0);
  EXPECT_GT(tet_volumes(mesh.V, mesh.T).minCoeff(), 0);
  EXPECT_LE(worst, tet_quality(mesh).min_dihedral + 1e-9);
  EXPECT_EQ(mesh.T, before.T);
  EXPECT_EQ(mesh.V.topRows(nasty.surface), before.V.topRows(nasty.surface));
}

TEST(ImproveTets, NamesWhatItRefuses) {
  TetMesh mesh;
  mesh.V.resize(4, 3);
  mesh.V << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  mesh.T.resize(1, 4);
  mesh.T << 0, 1, 2, 3;
  mesh.region = VectorXi::Ones(1);
  ImproveOptions options;
  options.target = 70;
  EXPECT_THROW(improve_tets(mesh, options), Error);
  options = {};
  options.give = VectorXd::Constant(4, -1);
  EXPECT_THROW(improve_tets(mesh, options), Error);
  TetMesh inverted = mesh;
  inverted.T << 1, 0, 2, 3;
  EXPECT_THROW(improve_tets(inverted), Error);
  Nasty nasty = nasty_balls();
  TetMesh& shuffled = nasty.mesh;  // last vertex, inside, becomes the first
  const int last = static_cast<int>(shuffled.V.rows()) - 1;
  shuffled.V.row(0).swap(shuffled.V.row(last));
  for (int& v : shuffled.T.reshaped()) v = v == 0 ? last : v == last ? 0 : v;
  try {
    improve_tets(shuffled);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("surfaces must come first"), std::string::npos) << error.what();
  }
}

TEST(TetShape, TheGradientFitsDifferencesWhereTheVolumeCountsToo) {
  Random random(4);
  int splinters = 0;
  for (int i = 0; i < 200; ++i) {
    Vector3d p[4];
    for (Vector3d& q : p) q = Vector3d(random.normal(), random.normal(), random.normal());
    if ((p[1] - p[0]).dot((p[2] - p[0]).cross(p[3] - p[0])) < 0) std::swap(p[0], p[1]);
    const double weight = 1, h = 1e-6;
    Vector3d gradient;
    const double shape = tet_shape(p[0], p[1], p[2], p[3], weight, gradient);
    EXPECT_NEAR(shape, tet_shape(p[0], p[1], p[2], p[3], weight), 1e-12);
    splinters += shape < least_sine(p[0], p[1], p[2], p[3]) ? 1 : 0;
    for (int k = 0; k < 3; ++k) {
      const Vector3d d = h * Vector3d::Unit(k);
      const double up = tet_shape(p[0] + d, p[1], p[2], p[3], weight),
                   down = tet_shape(p[0] - d, p[1], p[2], p[3], weight);
      if (std::abs(up + down - 2 * shape) > 1e-7) continue;  // a kink
      EXPECT_NEAR(gradient[k], (up - down) / (2 * h), 1e-4 * (1 + gradient.norm()));
    }
  }
  EXPECT_GT(splinters, 20);
  const Vector3d a(1, 1, 1), b(1, -1, -1), c(-1, 1, -1), d(-1, -1, 1);
  EXPECT_NEAR(std::abs(tet_shape(a, c, b, d, 0.5)), 0.5, 1e-14);
}

TEST(TetShape, LeastSineAgreesWithTheAnglesAndItsGradientWithDifferences) {
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    Vector3d p[4];
    for (Vector3d& q : p) q = Vector3d(random.normal(), random.normal(), random.normal());
    if ((p[1] - p[0]).dot((p[2] - p[0]).cross(p[3] - p[0])) < 0) std::swap(p[0], p[1]);
    const auto [low, high] = dihedral_range(p[0], p[1], p[2], p[3]);
    const double sine = least_sine(p[0], p[1], p[2], p[3]);
    EXPECT_NEAR(sine, std::sin(std::min(low, 180 - high) * M_PI / 180), 1e-9);
    EXPECT_LT(least_sine(p[1], p[0], p[2], p[3]), 0);
    Vector3d gradient;
    EXPECT_NEAR(least_sine(p[0], p[1], p[2], p[3], gradient), sine, 1e-12);
    const double h = 1e-6;
    for (int k = 0; k < 3; ++k) {
      const Vector3d d = h * Vector3d::Unit(k);
      const double up = least_sine(p[0] + d, p[1], p[2], p[3]), down = least_sine(p[0] - d, p[1], p[2], p[3]);
      if (std::abs(up + down - 2 * sine) > 1e-7) continue;  // a kink: another edge is the worst
      EXPECT_NEAR(gradient[k], (up - down) / (2 * h), 1e-4 * (1 + gradient.norm()));
    }
  }
}

/// `count` vertices round the z axis, between the vertices 0 below and 1 above.
TetMesh ring(int count, double height) {
  TetMesh mesh;
  mesh.V.resize(count + 2, 3);
  mesh.V.row(0) << 0, 0, -height;
  mesh.V.row(1) << 0, 0, height;
  mesh.T.resize(count, 4);
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * M_PI * i / count;
    mesh.V.row(i + 2) << std::cos(angle), std::sin(angle), 0;
    mesh.T.row(i) << 0, 1, i + 2, (i + 1) % count + 2;
  }
  mesh.region = VectorXi::Ones(count);
  return mesh;
}

TEST(TetFlips, AnEdgeIsRemovedAndItsFacesBringItBack) {
  for (const int count : {3, 4}) {
    const TetMesh tall = ring(count, 2.0);
    TetComplex complex(tall, {});
    std::vector<int> all;
    for (int t = 0; t < count; ++t) all.push_back(t);
    const double before = complex.worst(all);
    EXPECT_TRUE(remove_edge(complex, 0, 1)) << count;
    const TetMesh after = complex.mesh();
    EXPECT_NEAR(volume(after, 1), volume(tall, 1), 1e-12);
    EXPECT_EQ(after.T.rows(), 2 * count - 4);
    const TetComplex fresh(after, {});
    for (int t = 0; t < fresh.tets(); ++t) EXPECT_GT(fresh.tet(t).quality, before);
  }
  // Two flat caps become three tets round the edge between their apexes.
  TetComplex squat(ring(3, 2.0), {});
  EXPECT_TRUE(remove_edge(squat, 0, 1));
  EXPECT_EQ(squat.mesh().T.rows(), 2);
  TetMesh caps = squat.mesh();
  caps.V(0, 2) = -0.05;
  caps.V(1, 2) = 0.05;
  TetComplex flat(caps, {});
  bool back = false;
  for (int k = 0; k < 4 && !back; ++k) back = remove_faces(flat, 0, k);
  EXPECT_TRUE(back);
  EXPECT_EQ(flat.mesh().T.rows(), 3);
  EXPECT_NEAR(volume(flat.mesh(), 1), volume(caps, 1), 1e-12);
}

TEST(TetFlips, AnEdgeBetweenRegionsStays) {
  TetMesh mesh = ring(4, 2.0);
  mesh.region << 1, 1, 2, 2;
  TetComplex complex(mesh, {});
  EXPECT_FALSE(remove_edge(complex, 0, 1));
  EXPECT_EQ(complex.mesh().T, mesh.T);
}

TEST(TetComplex, ChangesCanBeTakenBack) {
  const Nasty nasty = nasty_balls();
  TetComplex complex(nasty.mesh, {});
  const std::size_t mark = complex.mark();
  int changes = 0;
  for (int t = 0; t < 400; ++t) {
    if (!complex.tet(t).alive) continue;
    const Corners v = complex.tet(t).v;
    for (const int corner : v) changes += smooth_vertex(complex, corner) ? 1 : 0;
    changes += remove_edge(complex, v[0], v[1]) || remove_faces(complex, t, 2) ? 1 : 0;
    if (complex.tet(t).alive) changes += contract_edge(complex, v[3], v[0]) || insert_vertex(complex, t) ? 1 : 0;
  }
  EXPECT_GT(changes, 100);
  EXPECT_NO_THROW(validate(complex.mesh(), "changed"));
  complex.take_back(mark);
  EXPECT_EQ(complex.mesh().V, nasty.mesh.V);
  EXPECT_EQ(complex.mesh().T, nasty.mesh.T);
}

}  // namespace
}  // namespace phiz
