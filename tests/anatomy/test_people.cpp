// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>

#include "anatomy/preview_head.h"
#include "phiz/anatomy/builtin/skin/people.h"
#include "phiz/anatomy/head_measures.h"
#include "phiz/anatomy/people/person.h"
#include "phiz/anatomy/people/reshape_head.h"
#include "phiz/anatomy/people/reshaped_expressions.h"
#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/tetrahedralise.h"

namespace phiz {
namespace {

using test::preview_head;

/// Largest distance between rows.
double apart(const MatrixX3d& a, const MatrixX3d& b) {
  return (a - b).rowwise().norm().maxCoeff();
}

TEST(People, CoefficientsAreDeviatesWithinTwoAndBelongToTheirSeed) {
  const VectorXd a = random_coefficients(preview_head().identity, 1);
  EXPECT_EQ(a.size(), preview_head().identity.skin.cols());
  EXPECT_EQ(a, random_coefficients(preview_head().identity, 1));
  EXPECT_NE(a, random_coefficients(preview_head().identity, 2));
  double sum = 0, square = 0, most = 0;
  constexpr int seeds = 400;
  for (int seed = 0; seed < seeds; ++seed) {
    const VectorXd c = random_coefficients(preview_head().identity, static_cast<std::uint64_t>(seed));
    sum += c.mean() / seeds;
    square += c.squaredNorm() / static_cast<double>(c.size()) / seeds;
    most = std::max(most, c.cwiseAbs().maxCoeff());
  }
  EXPECT_NEAR(sum, 0, 0.02);
  EXPECT_NEAR(square, 0.774, 0.03);  // variance of a normal deviate cut at 2
  EXPECT_LE(most, 2);
}

TEST(People, TheModesOfTheBuiltInHeadSpanItsParameters) {
  const SkinSurface mean = build_skin({}, {});
  const RefinedSkin skin = refine(mean, 0);
  const IdentityModel model = builtin_people(skin);
  ASSERT_EQ(model.skin.rows(), 3 * skin.mesh.V.rows());
  EXPECT_TRUE(std::is_sorted(model.deviation.begin(), model.deviation.end(), std::greater<>()));
  const MatrixXd modes = model.skin.cast<double>();
  for (const char* name : {"fat", "nose_length", "jaw_width"}) {
    IdentityParameters identity;
    for (const auto& parameter : identity_parameter_names)
      if (parameter.name == name) identity.*parameter.value = 1;
    const MatrixX3d there = refine(build_skin(personalise({}, identity), identity), 0).mesh.V;
    const VectorXd moved = (there - skin.mesh.V).reshaped<Eigen::RowMajor>();
    const VectorXd found = modes * modes.colPivHouseholderQr().solve(moved);
    EXPECT_GT(moved.norm(), 1e-3) << name;
    EXPECT_LT((found - moved).norm(), 0.1 * moved.norm()) << name;
  }
}

TEST(People, AreHeadsWhoseGeometryHolds) {
  for (const std::uint64_t seed : {1, 3}) {
    const HeadTemplate person = make_person(preview_head(), random_coefficients(preview_head().identity, seed));
    validate(person, "person");
    EXPECT_EQ(person.volume.T, preview_head().volume.T);
    EXPECT_EQ(person.identity.skin.cols(), 0);
    EXPECT_GT(apart(person.skin.V, preview_head().skin.V), 0.003);
    EXPECT_LT(person.jaw.centre.norm(), 1e-12);
    EXPECT_GE(simulated_bone_depth(person), 0.001) << seed;
    EXPECT_GE(drawn_bone_depth(person), 0.001) << seed;
    EXPECT_TRUE(self_intersections(simulation_skin(person)).empty()) << seed;
    EXPECT_LE(occlusion(person).interpenetration, 0.0003) << seed;
    EXPECT_GE(tet_quality(person.volume).min_dihedral, 2) << seed;
    for (const Muscle& muscle : person.muscles)
      EXPECT_GE(muscle_figures(person, muscle).share_in_flesh, 0.95) << muscle.name;
  }
}

TEST(People, TheSamePersonForAnyNumberOfThreads) {
  const VectorXd c = random_coefficients(preview_head().identity, 4);
  const HeadTemplate all = make_person(preview_head(), c);
  const ThreadLimit limit(1);
  const HeadTemplate one = make_person(preview_head(), c);
  EXPECT_EQ(all.volume.V, one.volume.V);
  for (std::size_t m = 0; m < all.muscles.size(); ++m) EXPECT_EQ(all.muscles[m].direction, one.muscles[m].direction);
}

TEST(People, WrongRequestsAreRefused) {
  HeadTemplate none = preview_head();
  none.identity = {};
  try {
    make_person(none, {});
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::bad_input);
    EXPECT_NE(std::string(e.what()).find("no model of people"), std::string::npos);
  }
  EXPECT_THROW(make_person(preview_head(), VectorXd::Zero(2)), Error);
  EXPECT_THROW(reshape_head(preview_head(), MatrixX3d::Zero(3, 3)), Error);
  MatrixX3d inside_out = preview_head().skin.V;
  inside_out.col(0) *= -1;
  EXPECT_THROW(reshape_head(preview_head(), inside_out), Error);
}

TEST(ReshapeHead, CarriesAnAffineMapToEverything) {
  const Vector3d stretch(1.06, 0.96, 1.03);
  const auto map = [&stretch](const MatrixX3d& points) -> MatrixX3d { return points * stretch.asDiagonal(); };
  const HeadTemplate wide = reshape_head(preview_head(), map(preview_head().skin.V));
  // Eyes stay round, tets get rounder by small moves.
  constexpr double exact = 1e-6, smoothed = 0.0006;
  EXPECT_LT(apart(wide.skin.V, map(preview_head().skin.V)), exact);
  EXPECT_LT(apart(wide.volume.V(preview_head().skin_vertices, Eigen::all),
                  map(preview_head().volume.V(preview_head().skin_vertices, Eigen::all))),
            smoothed);
  EXPECT_LT((wide.volume.V - map(preview_head().volume.V)).rowwise().norm().mean(), 0.0001);
  EXPECT_LT(apart(find_part(wide, "upperTeeth")->mesh.V, map(find_part(preview_head(), "upperTeeth")->mesh.V)), exact);
  const MatrixX3d eye = find_part(wide, "leftEye")->mesh.V.rowwise() - wide.left_eye_centre.transpose();
  const MatrixX3d before =
      find_part(preview_head(), "leftEye")->mesh.V.rowwise() - preview_head().left_eye_centre.transpose();
  const VectorXd ratio = eye.rowwise().norm().array() / before.rowwise().norm().array();
  EXPECT_NEAR(ratio.maxCoeff(), ratio.minCoeff(), 1e-9);
  EXPECT_GT(ratio.minCoeff(), 0.95);
  EXPECT_LT(ratio.maxCoeff(), 1.07);
  for (const Muscle& muscle : wide.muscles)
    EXPECT_NEAR((muscle.direction.rowwise().norm().array() - 1).abs().maxCoeff(), 0, 1e-9) << muscle.name;
}

TEST(ReshapeHead, TurnsWhatTheJawMovesAboutTheNewJoint) {
  HeadTemplate bare = preview_head();
  Expression open;
  open.name = "jawOpen";
  open.jaw << 0.3, 0.02, 0, -0.001, 0.004;
  const Eigen::Isometry3d pose = jaw_transform(bare.jaw, open.jaw);
  open.displacement = MatrixX3d::Zero(bare.skin.V.rows(), 3);
  const VectorXi& chin = bare.skin_regions.at("chin");
  for (const int v : chin) {
    const Vector3d p = bare.skin.V.row(v);
    open.displacement.row(v) = pose * p - p;
  }
  bare.expressions = {open};
  const HeadTemplate person = make_person(bare, random_coefficients(bare.identity, 5));
  const Eigen::Isometry3d moved = jaw_transform(person.jaw, open.jaw);
  for (const int v : chin) {
    const Vector3d p = person.skin.V.row(v);
    EXPECT_LT((person.expressions[0].displacement.row(v).transpose() - (moved * p - p)).norm(), 1e-5);
  }
}

TEST(LocalGradients, ReproduceAnAffineMapAndLeaveFlatNeighbourhoodsAcross) {
  MatrixX3d ball(500, 3), sheet(400, 3);
  for (Eigen::Index i = 0; i < ball.rows(); ++i) {
    const double t = static_cast<double>(i);
    ball.row(i) << 0.01 * std::sin(3 * t), 0.01 * std::cos(5 * t + 1), 0.01 * std::sin(7 * t + 2);
  }
  for (Eigen::Index i = 0; i < sheet.rows(); ++i)
    sheet.row(i) << 0.001 * static_cast<double>(i % 20 - 10), 0.001 * static_cast<double>(i / 20 - 10), 0;
  Matrix3d A;
  A << 1.1, 0.05, 0, -0.02, 0.9, 0.1, 0, 0.04, 1.2;
  const MatrixX3d origin = MatrixX3d::Zero(1, 3);
  const auto displaced = [&A](const MatrixX3d& points) -> MatrixX3d {
    return points * (A - Matrix3d::Identity()).transpose();
  };
  const Matrix3d in_ball = local_gradients(ball, displaced(ball), origin, 0.01).front();
  EXPECT_LT((in_ball - A).norm(), 0.1 * (A - Matrix3d::Identity()).norm());
  const Matrix3d on_sheet = local_gradients(sheet, displaced(sheet), origin, 0.005).front();
  EXPECT_LT((on_sheet - A).leftCols<2>().norm(), 0.1 * (A - Matrix3d::Identity()).norm());
  EXPECT_LT((on_sheet.col(2) - Vector3d::UnitZ()).norm(), 1e-9);
}

}  // namespace
}  // namespace phiz
