// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "anatomy/preview_head.h"
#include "phiz/anatomy/builtin/builtin_head.h"
#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/geometry/operators.h"
#include "phiz/geometry/spatial_query.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/tetrahedralise.h"
#include "phiz/geometry/topology.h"

namespace phiz {
namespace {

using test::preview_head;

HeadTemplate build(HeadSize size, std::optional<std::uint64_t> person = {}) {
  BuiltinOptions options;
  options.size = size;
  options.person = person;
  options.expressions = false;
  return build_builtin_head(options);
}

TriangleMesh bone_surface(const HeadTemplate& head, int region) {
  return remove_unused_vertices(head.volume.V, region_boundary(head.volume, region)).mesh;
}

/// What holds for every head.
void expect_sound(const HeadTemplate& head) {
  EXPECT_NO_THROW(validate(head, head.name));
  EXPECT_GT(tet_volumes(head.volume.V, head.volume.T).minCoeff(), 0);
  const TetQuality quality = tet_quality(head.volume);
  EXPECT_GE(quality.min_dihedral, 5) << brief_report(quality);
  const TriangleMesh skin{head.volume.V.topRows(head.skin_vertices.size()), head.skin_triangles, {}, {}};
  EXPECT_TRUE(is_closed(skin.F));
  const SurfaceQuery query(skin);
  for (const int region : {Tissue::skull, Tissue::mandible}) {
    const TriangleMesh bone = bone_surface(head, region);
    EXPECT_TRUE(is_closed(bone.F) && is_edge_manifold(bone.F) && is_oriented(bone.F));
    EXPECT_TRUE(self_intersections(bone).empty());
    for (Eigen::Index v = 0; v < bone.V.rows(); ++v)
      EXPECT_LT(query.signed_distance(bone.V.row(v)), -0.0006) << "region " << region << " vertex " << v;
  }
  // Skull and mandible do not touch.
  const TriangleMesh mandible = bone_surface(head, Tissue::mandible);
  const VectorXd gap = signed_distances(bone_surface(head, Tissue::skull), mandible.V);
  EXPECT_GT(gap.minCoeff(), 0.0002);
  EXPECT_GE(head.skull_landmarks.size(), 16U);
  EXPECT_EQ(head.muscles.size(), 37U);
  for (const char* part :
       {"skull", "mandible", "upperTeeth", "lowerTeeth", "upperGums", "lowerGums", "tongue", "leftEye", "rightEye"})
    EXPECT_NE(find_part(head, part), nullptr) << part;
  for (const ContactRegion& region : head.contact_regions) EXPECT_GT(region.triangles.rows(), 4) << region.name;
  for (int mark = 0; mark < 68; ++mark) {
    const std::string name = std::to_string(mark);
    EXPECT_TRUE(std::any_of(head.landmarks.begin(), head.landmarks.end(), [&](const Landmark& l) {
      return l.name == name;
    })) << name;
  }
}

TEST(BuiltinHead, PreviewIsSound) {
  expect_sound(preview_head());
  EXPECT_GT(soft_tets(preview_head()).size(), 6000);
  EXPECT_LT(soft_tets(preview_head()).size(), 10000);
}

TEST(BuiltinHead, StandardHasTheTetsOfThePapers) {
  const HeadTemplate head = build(HeadSize::standard);
  expect_sound(head);
  EXPECT_GE(soft_tets(head).size(), 35000);
  EXPECT_LE(soft_tets(head).size(), 40000);
}

TEST(BuiltinHead, RandomPeopleAreSoundAndDiffer) {
  const HeadTemplate a = build(HeadSize::preview, 11), b = build(HeadSize::preview, 12);
  expect_sound(a);
  expect_sound(b);
  ASSERT_EQ(a.skin.V.rows(), b.skin.V.rows());
  EXPECT_EQ(a.skin.F, b.skin.F);
  EXPECT_GT((a.skin.V - b.skin.V).rowwise().norm().maxCoeff(), 0.003);
}

TEST(BuiltinHead, SimulationSkinIsPartOfTheDrawnSkin) {
  const HeadTemplate& head = preview_head();
  const Eigen::Index s = head.skin_vertices.size();
  EXPECT_LT((head.skin_sampling * head.skin.V - head.volume.V.topRows(s)).cwiseAbs().maxCoeff(), 1e-12);
  const MatrixX3d shifted = head.skin_interpolation * MatrixX3d::Constant(s, 3, 0.01);
  EXPECT_LT((shifted.array() - 0.01).abs().maxCoeff(), 1e-8);
}

TEST(BuiltinHead, MusclesFillAFairShareOfTheFlesh) {
  const HeadTemplate& head = preview_head();
  const VectorXd volumes = tet_volumes(head.volume.V, head.volume.T);
  VectorXd share = VectorXd::Zero(volumes.size());
  for (const Muscle& m : head.muscles)
    for (Eigen::Index i = 0; i < m.tets.size(); ++i) share(m.tets(i)) += m.fraction(i);
  EXPECT_LE(share.maxCoeff(), 1 + 1e-9);
  EXPECT_GT(share.dot(volumes), 60e-6);  // 60 ml
}

TEST(BuiltinHead, DoesNotDependOnTheNumberOfThreads) {
  const ThreadLimit one(1);
  const HeadTemplate again = build(HeadSize::preview);
  EXPECT_EQ(again.volume.T, preview_head().volume.T);
  EXPECT_EQ(again.volume.V, preview_head().volume.V);
}

TEST(BuiltinHead, RefusesAnUnknownSize) {
  EXPECT_THROW(head_size("huge"), Error);
}

TEST(ValidateHead, NamesWhatIsWrong) {
  const auto complaint = [](auto damage) {
    HeadTemplate head = preview_head();
    damage(head);
    try {
      validate(head, "head.phiz");
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::bad_input);
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  const auto expect_says = [](const std::string& message, const char* part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_NE(message.find("head.phiz"), std::string::npos) << message;
  };
  expect_says(complaint([](HeadTemplate& h) { h.volume.V(7, 1) = std::nan(""); }), "7");
  expect_says(complaint([](HeadTemplate& h) { h.volume.V *= 1000; }), "metres");
  expect_says(complaint([](HeadTemplate& h) { std::swap(h.volume.T(5, 0), h.volume.T(5, 1)); }), "5");
  expect_says(complaint([](HeadTemplate& h) { h.carrier.conservativeResize(3); }), "carriers");
  expect_says(complaint([](HeadTemplate& h) { h.skin_triangles(3, 0) = 1 << 30; }), "skin_triangles row 3");
  expect_says(complaint([](HeadTemplate& h) { h.skin_interpolation *= 2; }), "skin_interpolation");
  expect_says(complaint([](HeadTemplate& h) { h.jaw.axis *= 2; }), "jaw");
  expect_says(complaint([](HeadTemplate& h) { h.contact_pairs.push_back({"upperLip", "moon"}); }), "moon");
  expect_says(complaint([](HeadTemplate& h) { h.muscles[2].fraction(0) = 2; }), "muscle");
  expect_says(complaint([](HeadTemplate& h) { h.skull_landmarks[0].bone_vertex = -1; }), "skull landmark");
  expect_says(complaint([](HeadTemplate& h) { h.landmarks[4].skin_vertex = -1; }), "landmark");
  expect_says(complaint([](HeadTemplate& h) { h.parts.push_back(h.parts[0]); }), "twice");
  expect_says(complaint([](HeadTemplate& h) {
                h.expressions.push_back({"jawOpen", MatrixX3d::Zero(3, 3), JawPose::Zero()});
              }),
              "jawOpen");
}

}  // namespace
}  // namespace phiz
