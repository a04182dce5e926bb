// SPDX-License-Identifier: GPL-3.0-or-later
// Dynamics of the reference engine (phace.md section 15.3).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "elasticity/tissue_blocks.h"
#include "phiz/elasticity/tissue_step.h"

namespace phiz {
namespace {

using testing::block;
using testing::breadth;
using testing::depth;
using testing::length;
using testing::pin;
using testing::rigid_box;
using testing::shaken;
using testing::vertices_where;
using testing::weigh;

TissueState at_rest(const TissueBody& body) {
  return {body.rest, MatrixX3d::Zero(body.rest.rows(), 3)};
}

Vector3d centre(const TissueEnergy& energy, const MatrixX3d& x) {
  return x.transpose() * energy.mass() / energy.mass().sum();
}

TEST(Dynamics, TheMassIsDensityTimesVolumeAndWhatIsCarried) {
  TissueBody body = block();
  weigh(body, Vector3d::Zero());
  body.added_mass = VectorXd::Constant(body.rest.rows(), 1e-4);
  EXPECT_NEAR(TissueEnergy(body).mass().sum(),
              1000 * length * breadth * depth + 1e-4 * static_cast<double>(body.rest.rows()), 1e-15);
}

TEST(Dynamics, GradientAndHessianWithInertiaAndForcesAgreeWithFiniteDifferences) {
  TissueBody body = block();
  weigh(body, {1, -9.81, 2});
  body.added_mass = VectorXd::LinSpaced(body.rest.rows(), 0, 1e-3);
  pin(body, [](const Vector3d& p) { return p.x() == 0; });
  TissueEnergy energy(body);
  energy.set_inertia(0.02, shaken(body.rest, 1e-3, 1));
  energy.set_forces(shaken(MatrixX3d::Zero(body.rest.rows(), 3), 1e-3, 2));
  const FreeMotion motion(body, body.rest);
  const MatrixX3d x = shaken(body.rest, 1e-3, 3);
  const VectorXd g = motion.reduced(energy.gradient(x));
  Random random(4);
  VectorXd d(motion.size());
  for (double& value : d) value = random.normal();
  constexpr double h = 1e-7;
  const MatrixX3d way = h * motion.expanded(d);
  EXPECT_NEAR((energy.value(x + way) - energy.value(x - way)) / (2 * h), g.dot(d), 1e-6 * g.norm() * d.norm());
  const VectorXd change = motion.reduced(energy.gradient(x + way) - energy.gradient(x - way)) / (2 * h);
  EXPECT_LT((change - energy.hessian(x, motion, Stiffness::exact) * d).norm(), 1e-6 * change.norm());
}

TEST(Dynamics, FreeFallIsTheOneOfBackwardEuler) {
  TissueBody body = block();
  const Vector3d gravity(1, -9.81, 2);
  weigh(body, gravity);
  TissueEnergy energy(body);
  TissueState state = at_rest(body);
  TissueStepOptions options;
  const double h = options.time_step;
  for (int k = 1; k <= 5; ++k) {
    const SolveStatistics statistics = step(energy, state, options);
    EXPECT_TRUE(statistics.converged) << brief_report(statistics);
    const MatrixX3d fallen = body.rest.rowwise() + (0.5 * k * (k + 1) * h * h * gravity).transpose();
    EXPECT_LT((state.x - fallen).cwiseAbs().maxCoeff(), 1e-11) << k;
    EXPECT_LT((state.v.rowwise() - k * h * gravity.transpose()).cwiseAbs().maxCoeff(), 1e-10) << k;
  }
}

TEST(Dynamics, DampingSlowsAFallToItsLastSpeed) {
  TissueBody body = block();
  weigh(body, {0, -9.81, 0});
  TissueEnergy energy(body);
  TissueState state = at_rest(body);
  TissueStepOptions options;
  options.damping = 20;
  double v = 0;
  for (int k = 0; k < 30; ++k) {
    step(energy, state, options);
    v = (v - 9.81 * options.time_step) / (1 + options.damping * options.time_step);
    EXPECT_NEAR(state.v.col(1).minCoeff(), v, 1e-9);
  }
  EXPECT_NEAR(v, -9.81 / options.damping, 1e-4);
}

TEST(Dynamics, SubstepsAreShorterSteps) {
  TissueBody body = block();
  weigh(body, {0, -9.81, 0});
  pin(body, [](const Vector3d& p) { return p.x() == 0; });
  TissueEnergy energy(body);
  MatrixX3d pins = body.rest, half = body.rest;
  pins.col(1).array() += 2e-3;
  half.col(1).array() += 1e-3;
  TissueState one = at_rest(body), two = one;
  TissueStepOptions options;
  options.substeps = 2;
  step(energy, one, options, pins);
  options.substeps = 1;
  options.time_step /= 2;
  step(energy, two, options, half);
  step(energy, two, options, pins);
  EXPECT_LT((one.x - two.x).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((one.v - two.v).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Dynamics, DampedMotionComesToRestInTheStaticState) {
  TissueBody body = block();
  weigh(body, {3, -9.81, 0});
  pin(body, [](const Vector3d& p) { return p.y() == breadth; });
  TissueEnergy energy(body);
  MatrixX3d still = body.rest;
  ASSERT_TRUE(solve_static(energy, still).converged);
  TissueState state = at_rest(body);
  TissueStepOptions options;
  options.damping = 40;
  double farthest = 0;
  for (int k = 0; k < 80; ++k) {
    EXPECT_TRUE(step(energy, state, options).converged);
    if (k == 0) farthest = (state.x - still).cwiseAbs().maxCoeff();
  }
  EXPECT_GT(farthest, 1e-4);
  EXPECT_LT((state.x - still).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_LT(state.v.cwiseAbs().maxCoeff(), 1e-7);
}

/// A block on a slope: the floor is y = 0 and gravity leans.
struct Slope {
  TissueBody body = block({2e4, 4e4});
  ContactScene contacts{body.rest.rows()};
  TissueStepOptions options;
  Vector3d gravity;

  Slope(double degrees, double friction) {
    const double angle = degrees * std::numbers::pi / 180;
    gravity = 9.81 * Vector3d(std::sin(angle), -std::cos(angle), 0);
    weigh(body, gravity);
    MatrixX3d above = body.rest;
    above.col(1).array() += 1e-4;
    const int floor = contacts.add_rigid(rigid_box({-0.2, -0.05, -0.2}, {0.8, 0, 0.2}));
    contacts.add_pair(vertices_where(body, [](const Vector3d& p) { return p.y() == 0; }), floor, -1, above);
    options.solve.friction = friction;
    options.damping = 2;
  }

  /// How far the block goes in ten steps after ten to settle, metres.
  double way() {
    TissueEnergy energy(body);
    TissueState state = at_rest(body);
    Vector3d from = Vector3d::Zero();
    for (int k = 0; k < 20; ++k) {
      if (k == 10) from = centre(energy, state.x);
      const SolveStatistics statistics = step(energy, state, options, {}, &contacts);
      EXPECT_TRUE(statistics.converged) << k << ": " << brief_report(statistics);
      EXPECT_LE(statistics.penetration, 1e-8);
    }
    return (centre(energy, state.x) - from).x();
  }
};

TEST(Dynamics, ABlockOnASlopeHoldsBelowTheAngleOfFrictionAndSlipsAboveIt) {
  constexpr double friction = 0.5;
  const double critical = std::atan(friction) * 180 / std::numbers::pi;
  EXPECT_LT(std::abs(Slope(critical - 0.5, friction).way()), 1e-6);
  EXPECT_GT(Slope(critical + 0.5, friction).way(), 1e-3);
}

TEST(Dynamics, WithoutFrictionABlockSlidesAsOnIce) {
  Slope slope(20, 0);
  slope.options.damping = 0;
  TissueEnergy energy(slope.body);
  TissueState state = at_rest(slope.body);
  const Vector3d from = centre(energy, state.x);
  const double h = slope.options.time_step;
  for (int k = 1; k <= 6; ++k) {
    const SolveStatistics statistics = step(energy, state, slope.options, {}, &slope.contacts);
    EXPECT_TRUE(statistics.converged) << brief_report(statistics);
    EXPECT_NEAR((centre(energy, state.x) - from).x(), 0.5 * k * (k + 1) * h * h * slope.gravity.x(), 1e-9);
  }
}

TEST(Dynamics, NonsenseIsRefused) {
  TissueBody body = block();
  TissueEnergy energy(body);
  TissueState state = at_rest(body);
  TissueStepOptions options;
  options.time_step = 0;
  EXPECT_ANY_THROW(step(energy, state, options));
  state.v.resize(2, 3);
  EXPECT_ANY_THROW(step(energy, state));
}

}  // namespace
}  // namespace phiz
