// SPDX-License-Identifier: GPL-3.0-or-later
// Contact of the real-time engine: closed forms, and the reference engine on the same problems.
#include <gtest/gtest.h>

#include <cmath>

#include "elasticity/contact_scenes.h"
#include "phiz/core/parallel.h"
#include "phiz/elasticity/tissue_newton.h"
#include "phiz/elasticity/tissue_solver.h"

namespace phiz {
namespace {

using testing::breadth;
using testing::depth;
using testing::Floor;
using testing::length;
using testing::Lips;
using testing::slide;

TissueSolverOptions to_a_micrometre() {
  TissueSolverOptions options;
  options.step_tolerance = 1e-6;
  options.max_iterations = 100;
  return options;
}

TEST(TissueSolverContact, TheFloorCarriesTheWeightOfABlockThatSags) {
  Floor on({0, -9.81, 0});
  slide(on.body, 0, 0, [](const Vector3d& p) { return p.x() == 0 && p.y() == breadth; });
  slide(on.body, 2, 0, [](const Vector3d& p) { return p.x() == 0 && p.y() == breadth && p.z() == 0; });
  TissueSolver solver(on.body, to_a_micrometre());
  const SolveStatistics statistics = solver.solve(on.body.rest, &on.contacts);
  EXPECT_TRUE(statistics.converged) << brief_report(statistics);
  const double weight = 1000 * length * breadth * depth * 9.81;
  EXPECT_NEAR(solver.contact_forces().col(1).sum(), weight, 1e-3 * weight);
  EXPECT_LT(on.contacts.penetration(solver.positions()), 1e-6);
  MatrixX3d x = solver.positions();
  ASSERT_TRUE(solve_static(TissueEnergy(on.body), x, {}, &on.contacts).converged);
  EXPECT_LT((x - solver.positions()).rowwise().norm().maxCoeff(), 5e-6);
}

TEST(TissueSolverContact, AgreesWithTheReferenceWhereSoftBlocksMeet) {
  const Lips lips;
  ContactScene contacts = lips.scene(), judge = lips.scene();
  const TissueEnergy energy(lips.body);
  TissueSolver solver(lips.body, to_a_micrometre());
  for (int frame = 1; frame <= 8; ++frame) {
    const double down = 2.5e-4 * frame;
    const MatrixX3d pins = lips.pressed(lips.body.rest, down, 0.3 * down);
    const SolveStatistics statistics = solver.solve(pins, &contacts);
    EXPECT_TRUE(statistics.converged) << frame << ": " << brief_report(statistics);
    EXPECT_LT(judge.penetration(solver.positions()), 5e-5) << frame;
    MatrixX3d x = solver.positions();
    ASSERT_TRUE(solve_static(energy, x, {}, &judge).converged) << frame;
    EXPECT_LT((x - solver.positions()).rowwise().norm().maxCoeff(), 1e-5) << frame;
  }
  const MatrixX3d push = solver.contact_forces();
  const Vector3d below = push.topRows(lips.split).colwise().sum();
  const Vector3d above = push.bottomRows(push.rows() - lips.split).colwise().sum();
  EXPECT_LT((below + above).norm(), 1e-6 * below.norm());
  EXPECT_LT(below.y(), 0);
}

TEST(TissueSolverContact, NothingIsJumpedOverWhenAllComesAtOnce) {
  const Lips lips;
  ContactScene contacts = lips.scene();
  TissueSolver solver(lips.body);
  const SolveStatistics statistics = solver.solve(lips.pressed(lips.body.rest, 3e-3, 0), &contacts);
  EXPECT_TRUE(statistics.converged) << brief_report(statistics);
  EXPECT_GT(statistics.contacts, 5);
  EXPECT_LT(contacts.penetration(solver.positions()), 5e-5);
  const VectorXd volumes = tet_volumes(solver.positions(), lips.body.tets);
  EXPECT_GT(volumes.minCoeff(), 0);
}

TEST(TissueSolverContact, OneThreadAndTwoGiveTheSameBits) {
  const Lips lips;
  std::vector<MatrixX3d> results;
  for (const int threads : {1, 0}) {
    const ThreadLimit limit(threads);
    ContactScene contacts = lips.scene();
    TissueSolver solver(lips.body);
    for (int frame = 1; frame <= 5; ++frame)
      solver.solve(lips.pressed(lips.body.rest, 4e-4 * frame, 1e-4 * frame), &contacts);
    results.push_back(solver.positions());
  }
  EXPECT_EQ(results[0], results[1]);
}

TEST(TissueSolverContact, TheTraceTellsOfEveryIteration) {
  const Lips lips;
  ContactScene contacts = lips.scene();
  TissueSolverOptions options = to_a_micrometre();
  Trace trace;
  options.trace = &trace;
  TissueSolver solver(lips.body, options);
  const SolveStatistics statistics = solver.solve(lips.pressed(lips.body.rest, 1.5e-3, 0), &contacts);
  ASSERT_FALSE(trace.empty());
  EXPECT_LE(static_cast<int>(trace.size()), statistics.iterations + 1);
  EXPECT_LT(trace.back().residual, trace.front().residual);
  EXPECT_LT(trace.back().last_step, trace.front().last_step);
}

}  // namespace
}  // namespace phiz
