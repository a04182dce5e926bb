// SPDX-License-Identifier: GPL-3.0-or-later
// Flesh that slides over curved bone.
#include <gtest/gtest.h>

#include <cmath>

#include "elasticity/tissue_blocks.h"
#include "phiz/elasticity/tissue_newton.h"

namespace phiz {
namespace {

using testing::block;
using testing::breadth;
using testing::depth;
using testing::length;
using testing::pin;
using testing::shaken;
using testing::weigh;

/// A block whose lower side is held to the paraboloid y = x^2 / 2 r + z^2 / 2 s about its middle.
TissueBody on_a_bowl() {
  TissueBody body = block();
  weigh(body, {4, -9.81, 2});
  const Vector3d lowest(0.5 * length, 0, 0.5 * depth);
  for (Eigen::Index v = 0; v < body.rest.rows(); ++v) {
    if (body.rest(v, 1) != 0) continue;
    Slide held;
    held.vertex = static_cast<int>(v);
    held.point = lowest;
    held.normal = Vector3d::UnitY();
    held.bend = Vector3d(1 / 0.06, 0, 1 / 0.08).asDiagonal();
    body.slides.push_back(held);
  }
  return body;
}

TEST(Slides, TheHessianAlongACurvedSurfaceAgreesWithFiniteDifferences) {
  const TissueBody body = on_a_bowl();
  const TissueEnergy energy(body);
  MatrixX3d x = shaken(body.rest, 5e-4, 3);
  put_on_slides(body, x);
  const FreeMotion motion(body, x);
  const VectorXd g = motion.reduced(energy.gradient(x));
  const SparseMatrixd H = energy.hessian(x, motion, Stiffness::exact);
  const auto along = [&](const VectorXd& q) {
    MatrixX3d y = x + motion.expanded(q);
    put_on_slides(body, y);
    return energy.value(y);
  };
  for (const Slide& slide : body.slides) {
    VectorXd d = VectorXd::Zero(motion.size());
    d.segment(motion.first(slide.vertex), 2) << 0.6, -0.8;
    constexpr double h = 1e-5;
    const double up = along(h * d), down = along(-h * d), here = along(0 * d);
    EXPECT_NEAR((up - down) / (2 * h), g.dot(d), 1e-5 * g.norm());
    EXPECT_NEAR((up - 2 * here + down) / (h * h), d.dot(H * d), 1e-5 * d.dot(H * d));
  }
  // The curvature is part of it.
  TissueEnergy flat = energy;
  std::vector<Slide> planes = body.slides;
  for (Slide& plane : planes) plane.bend.setZero();
  flat.set_slides(planes);
  EXPECT_GT((H - flat.hessian(x, motion, Stiffness::exact)).norm(), 1e-3 * H.norm());
}

TEST(Slides, ABlockInABowlComesToRestOnItQuadratically) {
  const TissueBody body = on_a_bowl();
  const TissueEnergy energy(body);
  MatrixX3d x = body.rest;
  Trace trace;
  NewtonStaticOptions options;
  options.trace = &trace;
  const SolveStatistics statistics = solve_static(energy, x, options);
  EXPECT_TRUE(statistics.converged) << brief_report(statistics);
  EXPECT_LE(statistics.residual, 1e-8);
  for (const Slide& slide : body.slides) EXPECT_NEAR(slide.height(x.row(slide.vertex)), 0, 1e-15);
  // Order of convergence from the last three residuals.
  ASSERT_GE(trace.size(), 2U);
  const double before = trace[trace.size() - 2].residual, last = trace.back().residual;
  EXPECT_LT(last, 1e-4);
  EXPECT_GT(std::log(statistics.residual / last) / std::log(last / before), 1.8);
  // Only pushes and pulls across the surface are left.
  const MatrixX3d force = energy.gradient(x);
  for (const Slide& slide : body.slides) {
    const Vector3d f = force.row(slide.vertex), n = slide.gradient(x.row(slide.vertex)).normalized();
    EXPECT_LT((f - f.dot(n) * n).norm(), 1e-6 * f.norm());
  }
}

TEST(Slides, TwoCurvedSlidesLeaveALine) {
  TissueBody body = block();
  Slide first, second;
  first.vertex = second.vertex = 0;
  first.point = second.point = Vector3d(0.001, 0.001, 0);
  first.normal = Vector3d::UnitX();
  second.normal = Vector3d::UnitY();
  first.bend = second.bend = Vector3d(0, 0, 5).asDiagonal();
  body.slides = {first, second};
  MatrixX3d x = body.rest;
  put_on_slides(body, x);
  EXPECT_EQ(FreeMotion(body, x).directions(0).cols(), 1);
  EXPECT_NEAR(first.height(x.row(0)), 0, 1e-15);
  EXPECT_NEAR(second.height(x.row(0)), 0, 1e-15);
}

}  // namespace
}  // namespace phiz
