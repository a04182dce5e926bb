// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>

#include "elasticity/blocks.h"
#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/elasticity/projective_dynamics.h"
#include "phiz/elasticity/terms.h"
#include "phiz/geometry/operators.h"

namespace phiz {
namespace {

using testing::body_of;
using testing::box;
using testing::shaken;

constexpr auto nowhere = [](const Vector3d&) { return false; };
constexpr auto at_bottom = [](const Vector3d& p) { return p.y() < 1e-9; };

TetMesh small_box() {
  return box(Vector3d::Zero(), Vector3d(0.04, 0.03, 0.02), 5, 4, 3);
}

ElasticBody hung_box(const TermWeights& weights) {
  ElasticBody body = body_of(small_box(), weights, at_bottom);
  body.attachments.push_back({7, 20.0, body.rest.row(7).transpose() + Vector3d(0.001, 0.002, 0)});
  body.attachments.push_back({11, 20.0, body.rest.row(11), Vector3d::UnitY()});
  return body;
}

TEST(ProjectiveDynamics, EnergyAndGradientOfTheKernelAreTheSumOfTheTerms) {
  const TermWeights weights{1.0, 0.7, 12.0};
  const ElasticBody body = body_of(small_box(), weights, nowhere);
  ElasticBody hung = body;
  hung.attachments.push_back({0, 1e-9, body.rest.row(0)});
  ProjectiveDynamics solver(hung);
  const TetRest rest = tet_rest(body.rest, body.tets);
  for (const double amount : {2e-4, 2e-3, 1e-2}) {  // the last one inverts tets
    const MatrixX3d x = shaken(body.rest, amount, 3);
    MatrixX3d gradient;
    const double energy = solver.energy(x, &gradient);
    double expected = 0;
    MatrixX3d expected_gradient = MatrixX3d::Zero(x.rows(), 3);
    for (Eigen::Index t = 0; t < body.tets.rows(); ++t) {
      const Matrix3d F = deformation_gradient(x, body.tets, rest, t);
      const Matrix3d I = Matrix3d::Identity();
      const double w = rest.volume[t] * body.stiffness[t];
      expected += w * (weights.target * target_energy(F, I) + weights.shape * shape_energy(F, I) +
                       weights.volume * volume_energy(F));
      const Matrix3d P = w * (weights.target * target_gradient(F, I) + weights.shape * shape_gradient(F, I) +
                              weights.volume * volume_gradient(F));
      const auto hats = hat_gradients(rest.inverse_edges[static_cast<std::size_t>(t)]);
      for (int c = 0; c < 4; ++c) expected_gradient.row(body.tets(t, c)) += (P * hats.col(c)).transpose();
    }
    EXPECT_NEAR(energy, expected, 1e-9 * expected);
    EXPECT_LT((gradient - expected_gradient).norm(), 1e-6 * expected_gradient.norm());
  }
}

TEST(ProjectiveDynamics, LocalGlobalStepsNeverRaiseTheEnergy) {
  ElasticBody body = hung_box({1, 1, 50});
  ProjectiveDynamics solver(body);
  MatrixX3d x = shaken(body.rest, 3e-3, 4);
  for (Eigen::Index v = 0; v < x.rows(); ++v)
    if (body.fixed[static_cast<std::size_t>(v)]) x.row(v) = body.rest.row(v);
  SolveOptions one;
  one.max_iterations = 1;
  one.history = 0;
  one.longest_step = 1;
  double last = solver.energy(x);
  for (int i = 0; i < 60; ++i) {
    solver.solve(x, one);
    const double now = solver.energy(x);
    EXPECT_LE(now, last * (1 + 1e-12));
    last = now;
  }
}

TEST(ProjectiveDynamics, AccelerationReachesTheSameStateAsPlainSteps) {
  const ElasticBody body = hung_box({1, 1, 20});
  ProjectiveDynamics solver(body);
  SolveOptions exact;
  exact.max_iterations = 20000;
  exact.step_tolerance = 1e-12;
  exact.residual_tolerance = 1e-9;
  SolveOptions plain = exact;
  plain.history = 0;
  MatrixX3d a = body.rest, b = body.rest;
  const SolveStatistics fast = solver.solve(a, exact);
  const SolveStatistics slow = solver.solve(b, plain);
  EXPECT_TRUE(fast.converged);
  EXPECT_TRUE(slow.converged);
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_LT(fast.iterations * 3, slow.iterations);
}

TEST(ProjectiveDynamics, ResultHasTheSameBitsForAnyNumberOfThreads) {
  const ElasticBody body = hung_box({1, 1, 20});
  MatrixX3d result[2];
  for (int k = 0; k < 2; ++k) {
    const ThreadLimit limit(k == 0 ? 1 : 4);
    ProjectiveDynamics solver(body);
    result[k] = body.rest;
    solver.solve(result[k], {});
  }
  EXPECT_EQ((result[0] - result[1]).cwiseAbs().maxCoeff(), 0.0);
}

TEST(ProjectiveDynamics, RigidMotionIsFreeOfEnergyAndForceWithoutATarget) {
  ElasticBody body = body_of(small_box(), {0, 2, 30}, at_bottom);
  ProjectiveDynamics solver(body);
  const Eigen::Isometry3d motion =
      Eigen::Translation3d(0.1, 0.2, -0.3) * Eigen::AngleAxisd(0.8, Vector3d(3, 1, 2).normalized());
  const MatrixX3d x = (body.rest * motion.linear().transpose()).rowwise() + motion.translation().transpose();
  MatrixX3d gradient;
  EXPECT_LT(solver.energy(x, &gradient), 1e-20);
  EXPECT_LT(gradient.cwiseAbs().maxCoeff(), 1e-10);
}

TEST(ProjectiveDynamics, TargetForcesIgnoreTranslationButNotRotation) {
  ElasticBody body = body_of(small_box(), {1, 0, 0}, at_bottom);
  ProjectiveDynamics solver(body);
  const MatrixX3d moved = body.rest.rowwise() + Eigen::RowVector3d(0.1, 0.2, 0.3);
  EXPECT_LT(solver.energy(moved), 1e-20);
  const MatrixX3d turned = body.rest * Eigen::AngleAxisd(0.3, Vector3d::UnitX()).toRotationMatrix().transpose();
  EXPECT_GT(solver.energy(turned), 1e-3);
}

TEST(ProjectiveDynamics, AReachableTargetIsReachedExactly) {
  // Affine field with determinant one: every tet can have its target, and bottom vertices are placed accordingly.
  Matrix3d F = Matrix3d::Identity();
  F(0, 1) = 0.3;
  const ElasticBody body = body_of(small_box(), {1, 1, 30}, at_bottom);
  ProjectiveDynamics solver(body);
  const Eigen::Matrix3d stretch = Eigen::SelfAdjointEigenSolver<Matrix3d>(F.transpose() * F).operatorSqrt();
  for (Eigen::Index t = 0; t < body.tets.rows(); ++t) solver.set_target(t, F, stretch);
  MatrixX3d x = body.rest;
  for (Eigen::Index v = 0; v < x.rows(); ++v)
    if (body.fixed[static_cast<std::size_t>(v)]) x.row(v) = body.rest.row(v) * F.transpose();
  SolveOptions exact;
  exact.max_iterations = 500;
  exact.step_tolerance = 1e-12;
  const SolveStatistics statistics = solver.solve(x, exact);
  EXPECT_LT((x - body.rest * F.transpose()).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_NEAR(statistics.volume_change, 0, 1e-9);
}

TEST(ProjectiveDynamics, AStateThatRoundingKeepsFromImprovingIsConverged) {
  ElasticBody body = body_of(small_box(), {1, 1, 30}, at_bottom);
  body.precision = Precision::single;
  ProjectiveDynamics solver(body);
  MatrixX3d x = shaken(body.rest, 1e-3, 3);
  SolveOptions options;
  options.max_iterations = 200;
  options.step_tolerance = 1e-6;
  options.residual_tolerance = 1e9;
  for (int again = 0; again < 30; ++again) {
    const SolveStatistics statistics = solver.solve(x, options);
    EXPECT_TRUE(statistics.converged) << again << ": " << brief_report(statistics);
  }
}

TEST(ProjectiveDynamics, VolumeTermKeepsTheVolumeOfASqueezedBlock) {
  double change[2];
  for (int k = 0; k < 2; ++k) {
    const TetMesh mesh = small_box();
    const ElasticBody body = body_of(mesh, {0.0, 1.0, k == 0 ? 0.0 : 1000.0},
                                     [](const Vector3d& p) { return p.y() < 1e-9 || p.y() > 0.03 - 1e-9; });
    ProjectiveDynamics solver(body);
    MatrixX3d x = mesh.V;
    x.col(1) *= 0.85;
    SolveOptions exact;
    exact.max_iterations = 3000;
    exact.step_tolerance = 1e-9;
    change[k] = solver.solve(x, exact).volume_change;
  }
  EXPECT_LT(change[0], -0.05);
  EXPECT_LT(std::abs(change[1]), 0.01);
}

TEST(ProjectiveDynamics, FreeFallIsExact) {
  ElasticBody body = body_of(small_box(), {1, 1, 10}, nowhere);
  body.time_step = 1.0 / 30;
  body.mass = lumped_tet_mass(body.rest, body.tets, 1000);
  ProjectiveDynamics solver(body);
  const Vector3d gravity(0, -9.81, 0);
  MatrixX3d x = body.rest, velocity = MatrixX3d::Zero(x.rows(), 3);
  const double h = body.time_step;
  SolveOptions exact;
  exact.step_tolerance = 1e-12;
  exact.max_iterations = 200;
  exact.longest_step = 1;
  for (int step = 1; step <= 8; ++step) {
    const MatrixX3d y = (x + h * velocity).rowwise() + h * h * gravity.transpose();
    solver.set_prediction(y);
    const MatrixX3d before = x;
    x = y;
    solver.solve(x, exact);
    velocity = (x - before) / h;
    const Vector3d fallen = h * h * step * (step + 1) / 2 * gravity;
    EXPECT_LT(((x - body.rest).rowwise() - fallen.transpose()).cwiseAbs().maxCoeff(), 1e-10);
  }
}

TEST(ProjectiveDynamics, MomentumIsKeptWithoutExternalForces) {
  ElasticBody body = body_of(small_box(), {0, 1, 10}, nowhere);
  body.time_step = 1.0 / 60;
  body.mass = lumped_tet_mass(body.rest, body.tets, 1000);
  ProjectiveDynamics solver(body);
  MatrixX3d x = shaken(body.rest, 1e-4, 9), velocity = MatrixX3d::Zero(x.rows(), 3);
  velocity.col(0).setConstant(0.1);
  SolveOptions exact;
  exact.step_tolerance = 1e-13;
  exact.residual_tolerance = 1e-8;
  exact.max_iterations = 400;
  const Vector3d before = body.mass.transpose() * velocity;
  for (int step = 0; step < 5; ++step) {
    const MatrixX3d old = x;
    solver.set_prediction(x + body.time_step * velocity);
    solver.solve(x, exact);
    velocity = (x - old) / body.time_step;
  }
  const Vector3d after = body.mass.transpose() * velocity;
  EXPECT_LT((after - before).norm(), 1e-6 * before.norm());
}

TEST(ProjectiveDynamics, DynamicsSettlesIntoTheStaticState) {
  ElasticBody body = body_of(small_box(), {1, 1, 10}, at_bottom);
  body.mass = lumped_tet_mass(body.rest, body.tets, 1000);
  MatrixX3d weight = MatrixX3d::Zero(body.rest.rows(), 3);
  weight.col(0) = 9.81 * body.mass;
  SolveOptions exact;
  exact.step_tolerance = 1e-11;
  exact.max_iterations = 400;
  ProjectiveDynamics statics(body);
  statics.set_forces(weight);
  MatrixX3d rest_state = body.rest;
  statics.solve(rest_state, exact);
  EXPECT_GT((rest_state - body.rest).cwiseAbs().maxCoeff(), 1e-5);

  body.time_step = 1.0 / 10;
  ProjectiveDynamics dynamics(body);
  dynamics.set_forces(weight);
  MatrixX3d x = body.rest, velocity = MatrixX3d::Zero(x.rows(), 3);
  for (int step = 0; step < 40; ++step) {
    const MatrixX3d old = x;
    dynamics.set_prediction(x + body.time_step * velocity);
    dynamics.solve(x, exact);
    velocity = (x - old) / body.time_step;
  }
  EXPECT_LT((x - rest_state).cwiseAbs().maxCoeff(), 1e-7);
}

TEST(ProjectiveDynamics, ABodyThatHangsOnNothingIsRefused) {
  try {
    ProjectiveDynamics solver(body_of(small_box(), {1, 1, 1}, nowhere));
    FAIL() << "accepted a floating body";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::failure);
  }
}

TEST(ProjectiveDynamics, MalformedBodiesAreRefused) {
  ElasticBody body = body_of(small_box(), {1, 1, 1}, at_bottom);
  body.tets(3, 2) = 100000;
  EXPECT_THROW(ProjectiveDynamics{body}, Error);
  body = body_of(small_box(), {1, 1, 1}, at_bottom);
  body.rest(5, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(ProjectiveDynamics{body}, Error);
  body = body_of(small_box(), {1, 1, 1}, at_bottom);
  std::swap(body.tets(0, 0), body.tets(0, 1));
  EXPECT_THROW(ProjectiveDynamics{body}, Error);
}

}  // namespace
}  // namespace phiz
