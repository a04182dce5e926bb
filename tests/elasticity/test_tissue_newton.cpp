// SPDX-License-Identifier: GPL-3.0-or-later
// Closed-form cases of statics (phace.md section 15.3).
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "elasticity/tissue_blocks.h"
#include "phiz/core/error.h"
#include "phiz/core/random.h"
#include "phiz/elasticity/tissue_newton.h"

namespace phiz {
namespace {

using testing::block;
using testing::breadth;
using testing::depth;
using testing::everywhere;
using testing::flesh;
using testing::length;
using testing::pin;
using testing::shaken;
using testing::slide;
using testing::total_volume;

/// sqrt(F^T F) of every tet less S: zero when all have that stretch, turned as they like.
double distance_from_stretch(const TissueBody& body, const MatrixX3d& x, const Matrix3d& S) {
  const TetRest rest = tet_rest(body.rest, body.tets);
  double most = 0;
  for (const Matrix3d& F : deformation_gradients(x, body.tets, rest))
    most = std::max(most, (F.transpose() * F - S * S).norm());
  return most;
}

TEST(Statics, GradientAndHessianAgreeWithFiniteDifferences) {
  TissueBody body = block();
  body.active = VectorXd::LinSpaced(body.tets.rows(), 0, 1);
  body.growth = VectorXd::LinSpaced(body.tets.rows(), 0.9, 1.2);
  body.density = VectorXd::Constant(body.tets.rows(), 1000);
  body.gravity = {1, -9.81, 2};
  pin(body, [](const Vector3d& p) { return p.x() == 0; });
  slide(body, 1, 0, [](const Vector3d& p) { return p.x() > 0 && p.y() == 0; });
  for (const PassiveLaw law : {PassiveLaw::corotated, PassiveLaw::neo_hookean}) {
    body.passive = law;
    TissueEnergy energy(body);
    energy.set_activation(everywhere(body, Vector3d(0.8, 1.1, 1.2).asDiagonal()));
    const FreeMotion motion(body, body.rest);
    const MatrixX3d x = shaken(body.rest, 1e-3, 4);
    const VectorXd g = motion.reduced(energy.gradient(x));
    const SparseMatrixd H = energy.hessian(x, motion, Stiffness::exact);
    Random random(5);
    VectorXd d(motion.size());
    for (double& value : d) value = random.normal();
    constexpr double h = 1e-7;
    const MatrixX3d way = h * motion.expanded(d);
    EXPECT_NEAR((energy.value(x + way) - energy.value(x - way)) / (2 * h), g.dot(d), 1e-6 * g.norm() * d.norm());
    const VectorXd change = motion.reduced(energy.gradient(x + way) - energy.gradient(x - way)) / (2 * h);
    EXPECT_LT((change - H * d).norm(), 1e-6 * change.norm());
  }
}

TEST(Statics, AFreeBlockTakesTheStretchOfItsActivation) {
  for (int mode = 0; mode < 6; ++mode) {
    TissueBody body = block();
    body.active = VectorXd::Ones(body.tets.rows());
    TissueEnergy energy(body);
    const Matrix3d S = activation_stretch(neutral_activation() + 0.2 * Vector6d::Unit(mode));
    energy.set_activation(everywhere(body, S));
    MatrixX3d x = body.rest;
    const SolveStatistics statistics = solve_static(energy, x);
    EXPECT_TRUE(statistics.converged) << brief_report(statistics);
    EXPECT_LT(statistics.energy, 1e-15) << mode;
    EXPECT_LT(distance_from_stretch(body, x, S), 1e-6) << mode;
    EXPECT_NEAR(total_volume(body, x) / (length * breadth * depth), S.determinant(), 1e-6);
  }
}

TEST(Statics, GrowthOfAFreeBlockIsFreeOfStress) {
  TissueBody body = block();
  body.growth = VectorXd::Constant(body.tets.rows(), 1.25);
  const TissueEnergy energy(body);
  MatrixX3d x = body.rest;
  const SolveStatistics statistics = solve_static(energy, x);
  EXPECT_TRUE(statistics.converged) << brief_report(statistics);
  EXPECT_LT(statistics.energy, 1e-15);
  EXPECT_NEAR(total_volume(body, x) / (length * breadth * depth), std::pow(1.25, 3), 1e-6);
}

TEST(Statics, UniaxialStretchIsTheClosedForm) {
  constexpr double a = 1.3;
  TissueBody body = block();
  slide(body, 0, 0, [](const Vector3d& p) { return p.x() == 0; });
  slide(body, 0, (a - 1) * length, [](const Vector3d& p) { return p.x() == length; });
  slide(body, 1, 0, [](const Vector3d& p) { return p.y() == 0; });
  slide(body, 2, 0, [](const Vector3d& p) { return p.z() == 0; });
  const TissueEnergy energy(body);
  MatrixX3d x = body.rest;
  const SolveStatistics statistics = solve_static(energy, x);
  EXPECT_TRUE(statistics.converged) << brief_report(statistics);
  // b across, from d/db [mu ((a-1)^2 + 2 (b-1)^2) + lambda (a b^2 - 1)^2] = 0.
  double low = 0.5, high = 1;
  for (int k = 0; k < 100; ++k) {
    const double b = 0.5 * (low + high);
    const double slope = flesh.mu * (b - 1) + flesh.lambda * (a * b * b - 1) * a * b;
    (slope > 0 ? high : low) = b;
  }
  const Matrix3d F = Vector3d(a, low, low).asDiagonal();
  EXPECT_LT((x - body.rest * F.transpose()).cwiseAbs().maxCoeff(), 1e-9);
  double pull = 0;
  const MatrixX3d reaction = energy.gradient(x);
  for (Eigen::Index v = 0; v < x.rows(); ++v)
    if (body.rest(v, 0) == length) pull += reaction(v, 0);
  const double expected =
      breadth * depth * (2 * flesh.mu * (a - 1) + 2 * flesh.lambda * (a * low * low - 1) * low * low);
  EXPECT_NEAR(pull, expected, 1e-8 * expected);
}

TEST(Statics, SimpleShearOfTheOutsideShearsTheInside) {
  Matrix3d F = Matrix3d::Identity();
  F(0, 1) = 0.4;
  for (const PassiveLaw law : {PassiveLaw::corotated, PassiveLaw::neo_hookean}) {
    TissueBody body = block();
    body.passive = law;
    pin(body, [](const Vector3d& p) {
      return p.x() == 0 || p.x() == length || p.y() == 0 || p.y() == breadth || p.z() == 0 || p.z() == depth;
    });
    const TissueEnergy energy(body);
    MatrixX3d x = body.rest * F.transpose();
    for (Eigen::Index v = 0; v < x.rows(); ++v)
      if (!body.pinned[static_cast<std::size_t>(v)]) x.row(v) = body.rest.row(v);
    const SolveStatistics statistics = solve_static(energy, x);
    EXPECT_TRUE(statistics.converged) << brief_report(statistics);
    EXPECT_LT((x - body.rest * F.transpose()).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(Statics, TheReactionToGravityIsTheWeight) {
  TissueBody body = block();
  body.density = VectorXd::Constant(body.tets.rows(), 1000);
  body.gravity = {0, -9.81, 0};
  pin(body, [](const Vector3d& p) { return p.y() == breadth; });
  const TissueEnergy energy(body);
  MatrixX3d x = body.rest;
  const SolveStatistics statistics = solve_static(energy, x);
  EXPECT_TRUE(statistics.converged) << brief_report(statistics);
  const double weight = 1000 * length * breadth * depth * 9.81;
  EXPECT_NEAR(energy.mass().sum() * 9.81, weight, 1e-12);
  const MatrixX3d force = energy.gradient(x);
  Vector3d reaction = Vector3d::Zero();
  for (Eigen::Index v = 0; v < x.rows(); ++v)
    if (body.pinned[static_cast<std::size_t>(v)]) reaction += force.row(v).transpose();
  EXPECT_LT((reaction - Vector3d(0, weight, 0)).norm(), 1e-7 * weight);
  EXPECT_LT(x.col(1).minCoeff(), -1e-4) << "it sags";
}

TEST(Statics, MuscleMovesAndTurnsNothingByItself) {
  TissueBody body = block();
  body.active = VectorXd::LinSpaced(body.tets.rows(), 0, 1);
  TissueEnergy energy(body);
  Random random(8);
  std::vector<Matrix3d> stretches;
  for (Eigen::Index t = 0; t < body.tets.rows(); ++t) {
    Vector6d a = neutral_activation();
    for (double& value : a) value += 0.2 * random.normal();
    stretches.push_back(activation_stretch(a));
  }
  energy.set_activation(stretches);
  const MatrixX3d x = shaken(body.rest, 2e-3, 9), force = energy.gradient(x);
  Vector3d sum = Vector3d::Zero(), torque = Vector3d::Zero();
  for (Eigen::Index v = 0; v < x.rows(); ++v) {
    sum += force.row(v).transpose();
    torque += Vector3d(x.row(v)).cross(Vector3d(force.row(v)));
  }
  EXPECT_LT(sum.norm(), 1e-12 * force.norm());
  EXPECT_LT(torque.norm(), 1e-12 * force.norm());
  const Eigen::Isometry3d turn = Eigen::Translation3d(0.1, -0.2, 0.3) * Eigen::AngleAxisd(1.2, Vector3d::UnitX());
  const MatrixX3d turned = (x * turn.linear().transpose()).rowwise() + turn.translation().transpose();
  EXPECT_NEAR(energy.value(turned), energy.value(x), 1e-10 * energy.value(x));
}

TEST(Statics, RelaxedMuscleIsPassiveTissue) {
  TissueBody body = block();
  const TissueEnergy passive(body);
  body.active = VectorXd::Constant(body.tets.rows(), 0.4);
  const TissueEnergy muscle(body);
  const MatrixX3d x = shaken(body.rest, 2e-3, 10);
  EXPECT_NEAR(muscle.value(x), passive.value(x), 1e-12 * passive.value(x));
  EXPECT_LT(muscle.gradient(body.rest).norm(), 1e-12) << "no force at rest";
}

TEST(Statics, MoreVolumeStiffnessKeepsMoreVolume) {
  double last = 1;
  for (const double lambda : {0.0, 1e3, 3e3, 1e4, 1e5}) {
    TissueBody body = block({1000, lambda});
    pin(body, [](const Vector3d& p) { return p.x() == 0 || p.x() == length; });
    const TissueEnergy energy(body);
    MatrixX3d x = body.rest;
    for (Eigen::Index v = 0; v < x.rows(); ++v)
      if (body.rest(v, 0) == length) x(v, 0) += 0.25 * length;
    const SolveStatistics statistics = solve_static(energy, x);
    EXPECT_TRUE(statistics.converged) << lambda << ": " << brief_report(statistics);
    const double error = std::abs(total_volume(body, x) / (length * breadth * depth) - 1);
    EXPECT_LT(error, last) << lambda;
    last = error;
  }
}

TEST(Statics, ScrambledAndFlattenedBlocksRecover) {
  // Co-rotated tissue has more minima: blocks with tets turned inside out.
  TissueBody body = block();
  body.passive = PassiveLaw::neo_hookean;
  pin(body, [](const Vector3d& p) { return p.x() == 0; });
  const TissueEnergy energy(body);
  for (int trial = 0; trial < 6; ++trial) {
    MatrixX3d x = trial < 3 ? shaken(body.rest, 0.01 * (trial + 1), static_cast<std::uint64_t>(20 + trial)) : body.rest;
    if (trial >= 3) x.col(trial - 3).setZero();
    for (Eigen::Index v = 0; v < x.rows(); ++v)
      if (body.pinned[static_cast<std::size_t>(v)]) x.row(v) = body.rest.row(v);
    const SolveStatistics statistics = solve_static(energy, x);
    EXPECT_TRUE(statistics.converged) << trial << ": " << brief_report(statistics);
    EXPECT_LT(statistics.energy, 1e-12) << trial;
    EXPECT_LT((x - body.rest).cwiseAbs().maxCoeff(), 1e-6) << trial;
  }
}

TEST(Statics, SlidesHoldTheirPlanesAndNothingElse) {
  TissueBody body = block();
  body.density = VectorXd::Constant(body.tets.rows(), 1000);
  body.gravity = {3, -9.81, 0};
  pin(body, [](const Vector3d& p) { return p.x() == 0 && p.y() == 0; });
  slide(body, 1, 0, [](const Vector3d& p) { return p.x() > 0 && p.y() == 0; });
  const TissueEnergy energy(body);
  MatrixX3d x = body.rest;
  const SolveStatistics statistics = solve_static(energy, x);
  EXPECT_TRUE(statistics.converged) << brief_report(statistics);
  double off = 0, along = 0;
  for (const Slide& s : body.slides) {
    off = std::max(off, std::abs(x(s.vertex, 1)));
    along = std::max(along, std::abs(x(s.vertex, 0) - body.rest(s.vertex, 0)));
  }
  EXPECT_LT(off, 1e-12);
  EXPECT_GT(along, 1e-4);
}

TEST(Statics, MalformedBodiesAreRefused) {
  const auto refused = [](auto&& damage) {
    TissueBody body = block();
    damage(body);
    EXPECT_THROW(TissueEnergy{body}, Error);
  };
  refused([](TissueBody& b) { b.tets(0, 0) = 10000; });
  refused([](TissueBody& b) { b.moduli[3].mu = -1; });
  refused([](TissueBody& b) { b.moduli.pop_back(); });
  refused([](TissueBody& b) { b.active = VectorXd::Constant(b.tets.rows(), 1.5); });
  refused([](TissueBody& b) { b.growth = VectorXd::Zero(b.tets.rows()); });
  refused([](TissueBody& b) { b.rest(0, 0) = std::nan(""); });
  refused([](TissueBody& b) { b.slides.push_back({0, Vector3d::Zero(), Vector3d::Zero()}); });
  refused([](TissueBody& b) { b.tets.row(0) << 0, 0, 1, 2; });
}

}  // namespace
}  // namespace phiz
