// SPDX-License-Identifier: GPL-3.0-or-later
// The real-time engine against the laws, the reference engine and closed forms.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "elasticity/blocks.h"
#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/core/random.h"
#include "phiz/elasticity/tissue_newton.h"
#include "phiz/elasticity/tissue_solver.h"
#include "phiz/elasticity/tissue_system.h"

namespace phiz {
namespace {

using testing::box;
using testing::shaken;

/// A block with muscle in half of it, pinned on the left, sliding on a curved floor.
TissueBody muscle_block() {
  const TetMesh mesh = box(Vector3d::Zero(), Vector3d(0.06, 0.03, 0.03), 8, 4, 4);
  TissueBody body;
  body.rest = mesh.V;
  body.tets = mesh.T;
  body.moduli.assign(static_cast<std::size_t>(mesh.T.rows()), {3000, 9000});
  body.active = VectorXd::Zero(mesh.T.rows());
  for (Eigen::Index t = 0; t < mesh.T.rows(); ++t)
    if (t % 2 == 0) body.active[t] = 0.2 + 0.8 * static_cast<double>(t) / static_cast<double>(mesh.T.rows());
  body.density = VectorXd::Constant(mesh.T.rows(), 1000);
  body.gravity = {0, -9.81, 0};
  body.pinned.resize(static_cast<std::size_t>(mesh.V.rows()));
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
    body.pinned[static_cast<std::size_t>(v)] = mesh.V(v, 0) == 0;
    if (mesh.V(v, 1) == 0 && mesh.V(v, 0) > 0.02) {
      Slide slide{static_cast<int>(v), mesh.V.row(v), Vector3d::UnitY(), Matrix3d::Zero()};
      slide.bend(0, 0) = 10;
      slide.bend(2, 2) = -5;
      body.slides.push_back(slide);
    }
  }
  return body;
}

std::vector<Matrix3d> contraction(const TissueBody& body, double share) {
  const Matrix3d S = fibre_stretch(Vector3d(1, 0.2, 0).normalized(), 1 - share) +
                     0.3 * share * Matrix3d(Vector3d(0, 1, 1).asDiagonal());
  return std::vector<Matrix3d>(static_cast<std::size_t>(body.tets.rows()), S);
}

double distance(const MatrixX3d& a, const MatrixX3d& b) {
  return (a - b).rowwise().norm().maxCoeff();
}

TEST(TissueSystem, EnergyForcesAndStiffnessAreThoseOfTheLaws) {
  TissueBody body = muscle_block();
  body.growth = VectorXd::LinSpaced(body.tets.rows(), 0.9, 1.2);
  for (const PassiveLaw law : {PassiveLaw::corotated, PassiveLaw::neo_hookean})
    for (const double amount : {1e-4, 2e-3, 2e-2}) {  // the last one turns tets inside out
      body.passive = law;
      TissueEnergy energy(body);
      TissueSystem system(body);
      energy.set_activation(contraction(body, 0.3));
      for (Eigen::Index t = 0; t < body.tets.rows(); ++t) system.blocks.set_stretch(t, contraction(body, 0.3)[0]);
      MatrixX3d x = shaken(body.rest, amount, 3);
      put_on_slides(body, x);
      AlignedDoubles at = zero_doubles(4 * system.rows), g = zero_doubles(4 * system.free);
      system.load(x, at.get());
      system.put_on_slides(at.get());
      double scale2 = 0;
      const double value = system.evaluate(at.get(), g.get(), &scale2);
      EXPECT_NEAR(value, energy.value(x), 2e-7 * std::abs(value));
      VectorXd magnitude;
      const MatrixX3d expected = energy.gradient(x, &magnitude);
      const double size = expected.norm();
      double expected_scale2 = 0;
      for (std::ptrdiff_t r = 0; r < system.free; ++r) {
        const Eigen::Index v = system.vertex_of[r];
        EXPECT_LT((Eigen::Map<Vector3d>(g.get() + 4 * r) - expected.row(v).transpose()).norm(), 2e-6 * size);
        expected_scale2 += magnitude[v] * magnitude[v];
      }
      EXPECT_NEAR(scale2, expected_scale2, 1e-5 * scale2);

      const FreeMotion motion(body, x);
      std::vector<float> room;
      BlockMatrix A = system.pattern;
      {
        system.assemble(system.stiffness_state(at.get(), g.get()), any_curvature, true, room, A);
        const SparseMatrixd H = energy.hessian(x, motion, Stiffness::exact);
        Random random(4);
        VectorXd d = VectorXd::NullaryExpr(motion.size(), [&] { return random.normal(); });
        const MatrixX3d way = motion.expanded(d), force = motion.expanded(H * d);
        MatrixX3d product = MatrixX3d::Zero(body.rest.rows(), 3);
        for (int j = 0; j < A.columns(); ++j)
          for (int k = A.start[j]; k < A.start[j + 1]; ++k) {
            const Matrix3d block = Eigen::Map<const Eigen::Matrix3f>(A.value.data() + 9 * k).cast<double>();
            const int row = system.vertex_of[A.row[k]], column = system.vertex_of[j];
            product.row(row) += (block * way.row(column).transpose()).transpose();
            if (row != column) product.row(column) += (block.transpose() * way.row(row).transpose()).transpose();
          }
        EXPECT_LT((product - force).norm(), 2e-5 * force.norm()) << amount;
      }
    }
}

TEST(TissueSolver, AgreesWithTheReferenceEngineAlongAMotion) {
  const TissueBody body = muscle_block();
  for (const PassiveLaw law : {PassiveLaw::corotated, PassiveLaw::neo_hookean}) {
    TissueBody mine = body;
    mine.passive = law;
    TissueSolverOptions options;
    options.step_tolerance = 1e-7;
    TissueSolver solver(mine, options);
    TissueEnergy energy(mine);
    MatrixX3d pins = body.rest;
    for (int frame = 0; frame < 6; ++frame) {
      const std::vector<Matrix3d> a = contraction(body, 0.05 * frame);
      solver.set_activation(a);
      energy.set_activation(a);
      for (Eigen::Index v = 0; v < pins.rows(); ++v)
        if (body.pinned[static_cast<std::size_t>(v)]) pins(v, 0) = body.rest(v, 0) - 5e-4 * frame;
      const SolveStatistics statistics = solver.solve(pins);
      EXPECT_TRUE(statistics.converged) << frame;
      MatrixX3d x = solver.positions();
      EXPECT_TRUE(solve_static(energy, x).converged);
      EXPECT_LT(distance(x, solver.positions()), 1e-6) << frame;
    }
  }
}

TEST(TissueSolver, RecoversFromScrambledAndFlattenedStarts) {
  for (const PassiveLaw law : {PassiveLaw::neo_hookean, PassiveLaw::corotated}) {
    TissueBody body = muscle_block();
    body.passive = law;
    body.active.resize(0);
    body.slides.clear();
    TissueEnergy energy(body);
    MatrixX3d solution = body.rest;
    ASSERT_TRUE(solve_static(energy, solution).converged);
    const double least = energy.value(solution);
    MatrixX3d flat = body.rest;
    flat.col(2).setConstant(0.01);
    // Inverted tets of the co-rotated law can be in a balance of their own: scrambled ones need not come home.
    std::vector<MatrixX3d> starts{flat};
    if (law == PassiveLaw::neo_hookean) starts.push_back(shaken(body.rest, 0.02, 8));
    for (const MatrixX3d& start : starts) {
      TissueSolverOptions options;
      options.step_tolerance = 1e-7;
      options.max_iterations = 400;
      TissueSolver solver(body, options);
      solver.restart(start);
      const SolveStatistics statistics = solver.solve(body.rest);
      EXPECT_TRUE(statistics.converged);
      EXPECT_NEAR(statistics.energy, least, 1e-6 * std::abs(least));
      MatrixX3d reference = start;
      for (Eigen::Index v = 0; v < reference.rows(); ++v)
        if (body.pinned[static_cast<std::size_t>(v)] != 0) reference.row(v) = body.rest.row(v);
      EXPECT_TRUE(solve_static(energy, reference).converged);
      EXPECT_NEAR(energy.value(reference), least, 1e-6 * std::abs(least));
    }
  }
}

TEST(TissueSolver, HasTheSameBitsForAnyThreadCountWithOrWithoutABackground) {
  const TissueBody body = muscle_block();
  std::vector<MatrixX3d> results;
  for (const bool background : {true, false}) {
    const ThreadLimit limit(background ? 0 : 1);
    TissueSolverOptions options;
    options.background = background;
    options.refresh_iterations = 1;
    options.refresh_solves = 2;
    TissueSolver solver(body, options);
    for (int frame = 0; frame < 8; ++frame) {
      solver.set_activation(contraction(body, 0.04 * frame));
      solver.solve(body.rest);
    }
    EXPECT_GT(solver.counts().factorisations, 2);
    results.push_back(solver.positions());
  }
  EXPECT_EQ(results[0], results[1]);
}

}  // namespace
}  // namespace phiz
