// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "phiz/anatomy/builtin/skin/eye.h"
#include "phiz/anatomy/builtin/skin/surface.h"
#include "phiz/anatomy/builtin/skin/topology.h"
#include "phiz/core/error.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/topology.h"

namespace phiz {
namespace {

SkinSurface person(std::uint64_t seed) {
  const IdentityParameters identity = seed == 0 ? IdentityParameters{} : random_identity(seed);
  return build_skin(personalise({}, identity), identity);
}

const SkinSurface& mean_person() {
  static const SkinSurface skin = person(0);
  return skin;
}

/// Shortest distance from point to any of the listed vertices.
double distance_to(const Vector3d& point, const MatrixX3d& V, const VectorXi& rows) {
  double least = std::numeric_limits<double>::infinity();
  for (int v : rows) least = std::min(least, (V.row(v).transpose() - point).norm());
  return least;
}

TEST(Skin, IsOneClosedOrientedManifoldAtEveryLevel) {
  for (int level = 0; level <= 3; ++level) {
    const RefinedSkin skin = refine(mean_person(), level);
    EXPECT_TRUE(is_closed(skin.mesh.F)) << level;
    EXPECT_TRUE(is_edge_manifold(skin.mesh.F)) << level;
    EXPECT_TRUE(is_vertex_manifold(skin.mesh.F)) << level;
    EXPECT_TRUE(is_oriented(skin.mesh.F)) << level;
    EXPECT_EQ(triangle_components(skin.mesh.F).maxCoeff(), 0) << level;
    const double litres = 1e3 * signed_volume(skin.mesh.V, skin.mesh.F);
    EXPECT_GT(litres, 3.5) << level;
    EXPECT_LT(litres, 5.5) << level;
  }
}

TEST(Skin, DoesNotIntersectItselfForAnyone) {
  for (std::uint64_t seed = 0; seed <= 12; ++seed) {
    const SkinSurface skin = person(seed);
    for (int level = 0; level <= 2; ++level)
      EXPECT_TRUE(self_intersections(refine(skin, level).mesh).empty()) << "person " << seed << ", level " << level;
  }
}

TEST(Skin, ExtremeEarsStayClearOfTheHead) {
  for (const double flare : {-2.5, 2.5})
    for (const double size : {-2.5, 2.5}) {
      IdentityParameters identity;
      identity.ear_flare = flare;
      identity.ear_size = size;
      const SkinSurface skin = build_skin(personalise({}, identity), identity);
      EXPECT_TRUE(self_intersections(refine(skin, 1).mesh).empty()) << "flare " << flare << ", size " << size;
    }
}

TEST(Skin, IsSymmetricForSymmetricParameters) {
  const SkinTopology& topology = skin_topology();
  for (std::uint64_t seed : {0, 7}) {
    const MatrixX3d V = person(seed).cage.V;
    for (int v = 0; v < topology.vertex_count(); ++v) {
      const Eigen::RowVector3d mirrored(-V(v, 0), V(v, 1), V(v, 2));
      EXPECT_EQ((V.row(topology.mirror(v)) - mirrored).norm(), 0) << v;
    }
  }
}

TEST(Skin, LevelsInterpolateTheSameSurface) {
  const RefinedSkin coarse = refine(mean_person(), 0), middle = refine(mean_person(), 1),
                    fine = refine(mean_person(), 2);
  EXPECT_LT((coarse.mesh.V - middle.mesh.V.topRows(coarse.mesh.V.rows())).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((middle.mesh.V - fine.mesh.V.topRows(middle.mesh.V.rows())).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Skin, WeightsSumToOne) {
  for (int level = 0; level <= 2; ++level) {
    const RefinedSkin skin = refine(mean_person(), level);
    const VectorXd sums = skin.from_cage * VectorXd::Ones(skin.from_cage.cols());
    EXPECT_LT((sums.array() - 1).abs().maxCoeff(), 1e-12) << level;
    EXPECT_LT((skin.from_cage * mean_person().cage.V - skin.mesh.V).cwiseAbs().maxCoeff(), 1e-12) << level;
  }
}

TEST(Skin, DisplacementsCarryOverToFinerLevels) {
  const RefinedSkin coarse = refine(mean_person(), 0), fine = refine(mean_person(), 2);
  const SparseMatrixd carry = skin_interpolation_between(mean_person(), 0, 2);
  ASSERT_EQ(carry.rows(), fine.mesh.V.rows());
  ASSERT_EQ(carry.cols(), coarse.mesh.V.rows());
  const VectorXd sums = carry * VectorXd::Ones(carry.cols());
  EXPECT_LT((sums.array() - 1).abs().maxCoeff(), 1e-12);
  // A smooth displacement arrives nearly unchanged.
  const auto field = [](const MatrixX3d& V) -> VectorXd { return 0.01 * (V.col(1).array() * 8).sin(); };
  EXPECT_LT((carry * field(coarse.mesh.V) - field(fine.mesh.V)).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(Skin, RegionsAreThereAtEveryLevel) {
  for (int level = 0; level <= 2; ++level) {
    const RefinedSkin skin = refine(mean_person(), level);
    for (const char* name :
         {"upperLip",     "lowerLip",      "upperLipInner", "lowerLipInner", "mouthBag",   "oralRoof",    "oralFloor",
          "leftUpperLid", "rightUpperLid", "leftLowerLid",  "rightLowerLid", "leftSocket", "rightSocket", "leftNostril",
          "rightNostril", "nose",          "leftEar",       "rightEar",      "scalp",      "forehead",    "leftBrow",
          "rightBrow",    "leftCheek",     "rightCheek",    "chin",          "neck",       "neckCap",     "jawLine"}) {
      ASSERT_TRUE(skin.regions.contains(name)) << name;
      EXPECT_GT(skin.regions.at(name).size(), 4) << name << ", level " << level;
    }
    std::set<std::pair<int, int>> edges;
    for (const auto& q : skin.quads.faces)
      for (int k = 0; k < 4; ++k) edges.insert(std::minmax(q[k], q[(k + 1) % 4]));
    for (const auto& [name, path] : skin.regions) {
      if (!name.starts_with("loop:")) continue;
      for (Eigen::Index k = 0; k + 1 < path.size(); ++k)
        EXPECT_TRUE(edges.contains(std::minmax(path[k], path[k + 1]))) << name << ", level " << level;
    }
  }
}

TEST(Skin, HasTheSixtyEightLandmarksInMirrorImage) {
  const SkinSurface& skin = mean_person();
  std::map<std::string, int> vertex;
  for (const Landmark& landmark : skin.landmarks)
    EXPECT_TRUE(vertex.emplace(landmark.name, landmark.skin_vertex).second);
  for (int k = 0; k < 68; ++k) {
    ASSERT_TRUE(vertex.contains(std::to_string(k))) << k;
    ASSERT_LT(vertex[std::to_string(k)], skin.cage.V.rows());
  }
  const auto at = [&](int k) -> Vector3d { return skin.cage.V.row(vertex[std::to_string(k)]); };
  for (const auto& [right, left] :
       {std::pair(0, 16), {4, 12}, {17, 26}, {21, 22}, {31, 35}, {36, 45}, {39, 42}, {48, 54}, {60, 64}}) {
    EXPECT_GT(at(left).x(), 0);
    EXPECT_NEAR(at(left).x(), -at(right).x(), 1e-12);
  }
  EXPECT_GT(at(27).y(), at(30).y());  // bridge above tip
  EXPECT_GT(at(51).y(), at(57).y());  // upper above lower lip
  EXPECT_GT(at(8).z(), at(4).z());    // chin before jaw
}

TEST(Skin, TextureMapFillsTheUnitSquareWithoutOverlap) {
  const RefinedSkin skin = refine(mean_person(), 1);
  EXPECT_GE(skin.mesh.UV.minCoeff(), 0);
  EXPECT_LE(skin.mesh.UV.maxCoeff(), 1);
  constexpr int size = 700;
  std::vector<int> cover(size * size, 0);
  for (Eigen::Index f = 0; f < skin.mesh.FUV.rows(); ++f) {
    const auto corner = [&](int k) -> Vector2d { return skin.mesh.UV.row(skin.mesh.FUV(f, k)); };
    const Vector2d a = corner(0), b = corner(1), c = corner(2);
    const auto side = [](const Vector2d& p, const Vector2d& q, const Vector2d& r) {
      return (q.x() - p.x()) * (r.y() - p.y()) - (q.y() - p.y()) * (r.x() - p.x());
    };
    EXPECT_GT(side(a, b, c), 0) << "triangle " << f;
    const Vector2d low = a.cwiseMin(b).cwiseMin(c) * size, high = a.cwiseMax(b).cwiseMax(c) * size;
    for (int y = static_cast<int>(low.y()); y <= std::min(size - 1.0, high.y()); ++y)
      for (int x = static_cast<int>(low.x()); x <= std::min(size - 1.0, high.x()); ++x) {
        const Vector2d p((x + 0.5) / size, (y + 0.5) / size);
        constexpr double inside = 1e-12;  // points on an edge belong to no triangle
        if (side(a, b, p) > inside && side(b, c, p) > inside && side(c, a, p) > inside) ++cover[y * size + x];
      }
  }
  EXPECT_LE(*std::max_element(cover.begin(), cover.end()), 1);
  const double share = static_cast<double>(std::count(cover.begin(), cover.end(), 1)) / (size * size);
  EXPECT_GT(share, 0.6);
}

TEST(Skin, ConnectivityAndTextureMapAreTheSameForEverybody) {
  const SkinSurface other = person(3);
  EXPECT_EQ(other.cage.faces, mean_person().cage.faces);
  EXPECT_EQ(other.cage.face_uvs, mean_person().cage.face_uvs);
  EXPECT_EQ((other.cage.UV - mean_person().cage.UV).norm(), 0);
  EXPECT_EQ(refine(other, 1).mesh.F, refine(mean_person(), 1).mesh.F);
}

TEST(Skin, MouthIsClosedButTheLipsDoNotTouch) {
  for (std::uint64_t seed : {0, 2, 5}) {
    const RefinedSkin skin = refine(person(seed), 2);
    const VectorXi &upper = skin.regions.at("upperLip"), &lower = skin.regions.at("lowerLip");
    std::set<int> corner(upper.begin(), upper.end());  // the column at the corner belongs to both lips
    double least = 1;
    for (int v : lower)
      if (!corner.contains(v) && std::abs(skin.mesh.V(v, 0)) < 0.020)
        least = std::min(least, distance_to(skin.mesh.V.row(v), skin.mesh.V, upper));
    EXPECT_GT(least, 0.05e-3) << seed;
    EXPECT_LT(least, 0.35e-3) << seed;
  }
}

TEST(Skin, LidsAndSocketsEncloseTheEyeballs) {
  for (std::uint64_t seed = 0; seed <= 8; ++seed) {
    const IdentityParameters identity = seed == 0 ? IdentityParameters{} : random_identity(seed);
    const Proportions proportions = personalise({}, identity);
    const RefinedSkin skin = refine(build_skin(proportions, identity), 2);
    const VectorXd gap =
        (skin.mesh.V.rowwise() - proportions.eye_centre.transpose()).rowwise().norm().array() - proportions.eye_radius;
    EXPECT_GT(gap.minCoeff(), 0.02e-3) << seed;
    double margin = 1;
    for (int v : skin.regions.at("leftUpperLid")) margin = std::min(margin, gap[v]);
    EXPECT_LT(margin, 0.4e-3) << seed;
  }
}

TEST(Skin, CheeksAreThick) {
  for (std::uint64_t seed : {0, 1, 4, 9}) {
    const RefinedSkin skin = refine(person(seed), 1);
    for (int v : skin.regions.at("mouthBag"))
      for (const char* outer : {"leftCheek", "rightCheek", "chin", "jawLine", "nose"})
        EXPECT_GT(distance_to(skin.mesh.V.row(v), skin.mesh.V, skin.regions.at(outer)), 4e-3)
            << outer << ", person " << seed;
  }
}

TEST(Skin, EveryParameterChangesTheSkinVisibly) {
  for (const auto& parameter : identity_parameter_names) {
    IdentityParameters identity;
    identity.*parameter.value = 2;
    const MatrixX3d V = build_skin(personalise({}, identity), identity).cage.V;
    const double change = (V - mean_person().cage.V).rowwise().norm().maxCoeff();
    EXPECT_GT(change, 0.5e-3) << parameter.name;
    EXPECT_LT(change, 20e-3) << parameter.name;
  }
}

TEST(Skin, RandomPeopleAreRepeatableAndDiffer) {
  const MatrixX3d once = person(11).cage.V, again = person(11).cage.V, other = person(12).cage.V;
  EXPECT_EQ((once - again).norm(), 0);
  EXPECT_GT((once - other).rowwise().norm().maxCoeff(), 2e-3);
}

TEST(Skin, PeopleDifferAsWidelyAsAdultsDo) {
  // Standard deviations of adults of both sexes, millimetres: Zhuang and Bradtmiller (2005), rounded.
  struct Distance {
    const char* name;
    double deviation;
    double (*of)(const Proportions&);
  };
  const Distance distances[] = {
      {"head breadth", 6.5, [](const Proportions& p) { return 2 * p.euryon.x(); }},
      {"head length", 8.5, [](const Proportions& p) { return p.glabella.y() - p.opisthocranion.y(); }},
      {"bizygomatic", 7.7, [](const Proportions& p) { return 2 * p.zygion.x(); }},
      {"bigonial", 10, [](const Proportions& p) { return 2 * p.gonion.x(); }},
      {"nasion to menton", 7.5, [](const Proportions& p) { return p.nasion.x() - p.menton.x(); }},
      {"nasion to subnasale", 4.3, [](const Proportions& p) { return p.nasion.x() - p.subnasale.x(); }},
      {"nose breadth", 4.2, [](const Proportions& p) { return 2 * p.alare.x(); }},
      {"mouth breadth", 4.3, [](const Proportions& p) { return 2 * p.cheilion.x(); }},
      {"between the eyes", 3.7, [](const Proportions& p) { return 2 * p.eye_centre.x(); }},
  };
  constexpr int people = 1000;
  for (const Distance& distance : distances) {
    VectorXd values(people);
    for (int k = 0; k < people; ++k) values[k] = 1e3 * distance.of(personalise({}, random_identity(k)));
    const double deviation = std::sqrt((values.array() - values.mean()).square().mean());
    EXPECT_GT(deviation, 0.7 * distance.deviation) << distance.name;
    EXPECT_LT(deviation, 1.2 * distance.deviation) << distance.name;
    EXPECT_NEAR(values.mean(), 1e3 * distance.of({}), 0.1 * distance.deviation) << distance.name;
  }
}

TEST(Skin, ProfileHasChinAndThroat) {
  const Proportions p;
  // Lips lie a little behind the line from the tip of the nose to the chin.
  const auto behind = [&](const Vector2d& lip) {
    const double t = (lip.x() - p.pronasale.x()) / (p.pogonion.x() - p.pronasale.x());
    return 1e3 * (p.pronasale.y() + t * (p.pogonion.y() - p.pronasale.y()) - lip.y());
  };
  for (const Vector2d& lip : {p.labrale_superius, p.labrale_inferius}) {
    EXPECT_GT(behind(lip), 1);
    EXPECT_LT(behind(lip), 6);
  }
  // From the chin the skin runs back, then turns down the throat.
  const SkinTopology& t = skin_topology();
  const MatrixX3d V = refine(mean_person(), 0).mesh.V;
  const auto midline = [&](int row) -> Vector3d { return V.row(t.sheet(0, row)); };
  const Vector3d floor = midline(3) - midline(5), throat = midline(1) - midline(3);
  const double angle = 180 / M_PI * std::acos(floor.normalized().dot(-throat.normalized()));
  EXPECT_GT(angle, 100);
  EXPECT_LT(angle, 135);
}

TEST(Skin, MeanFaceHasThePublishedDistances) {
  // Adults, means over the sexes of doi 10.1186/s40902-019-0191-7 and of doi 10.1186/2196-1042-14-32, millimetres.
  const SkinSurface& skin = mean_person();
  const MatrixX3d V = 1e3 * refine(skin, 0).mesh.V;
  const auto at = [&](const std::string& name) -> Vector3d {
    for (const Landmark& landmark : skin.landmarks)
      if (landmark.name == name) return V.row(landmark.skin_vertex);
    ADD_FAILURE() << name;
    return Vector3d::Zero();
  };
  const auto across = [&](const std::string& name) { return (at("left" + name) - at("right" + name)).norm(); };
  const auto between = [&](const std::string& a, const std::string& b) { return (at(a) - at(b)).norm(); };
  EXPECT_NEAR(across("Endocanthion"), 32, 2);
  EXPECT_NEAR(across("Exocanthion"), 94, 3);
  EXPECT_NEAR(between("leftEndocanthion", "leftExocanthion"), 31, 2);
  EXPECT_NEAR(across("Alare"), 37, 2);
  EXPECT_NEAR(across("Cheilion"), 50, 2);
  EXPECT_NEAR(across("Tragion"), 141, 4);
  EXPECT_NEAR(between("nasion", "pronasale"), 45, 3);
  EXPECT_NEAR(between("nasion", "subnasale"), 50, 3);
  EXPECT_NEAR(between("subnasale", "menton"), 70, 4);
}

TEST(Skin, LidsFrameTheIrisAsAtRest) {
  const SkinTopology& topology = skin_topology();
  const Proportions p;
  const MatrixX3d V = 1e3 * refine(mean_person(), 0).mesh.V;
  constexpr double iris = 5.9;
  const auto margin = [&](int c) { return V(topology.eye(6, c), 1) - 1e3 * p.eye_centre.y(); };
  EXPECT_GT(iris - margin(4), 1);  // the upper lid covers 1 to 2.5 mm of it
  EXPECT_LT(iris - margin(4), 2.5);
  EXPECT_NEAR(margin(12), -iris, 0.6);  // the lower lid touches it
}

TEST(Skin, RefusesNonsense) {
  IdentityParameters identity;
  identity.fat = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(personalise({}, identity), Error);
  EXPECT_THROW(build_skin({}, identity), Error);
  identity.fat = 40;
  EXPECT_THROW(personalise({}, identity), Error);
  Proportions millimetres;
  millimetres.vertex *= 1000;
  EXPECT_THROW(build_skin(millimetres, {}), Error);
  EXPECT_THROW(refine(mean_person(), 9), Error);
  EXPECT_THROW(refine(mean_person(), -1), Error);
  EXPECT_THROW(skin_interpolation_between(mean_person(), 2, 1), Error);
  EXPECT_THROW(build_eye({}, true, 1), Error);
}

TEST(Eye, IsAClosedBallWithIrisAndPupil) {
  for (const bool left : {true, false}) {
    const Proportions proportions;
    const Eye eye = build_eye(proportions, left);
    EXPECT_TRUE(is_closed(eye.mesh.F));
    EXPECT_TRUE(is_oriented(eye.mesh.F));
    EXPECT_NEAR(signed_volume(eye.mesh.V, eye.mesh.F), 4.0 / 3 * M_PI * std::pow(proportions.eye_radius, 3),
                0.02 * 7.2e-6);
    EXPECT_EQ(eye.part.size(), eye.mesh.F.rows());
    for (const EyePart part : {EyePart::sclera, EyePart::iris, EyePart::pupil})
      EXPECT_GT((eye.part.array() == static_cast<int>(part)).count(), 20);
    EXPECT_GT(eye.mesh.V.col(2).maxCoeff(), proportions.eye_centre.z() + proportions.eye_radius);  // the cornea bulges
  }
}

}  // namespace
}  // namespace phiz
