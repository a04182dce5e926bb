// SPDX-License-Identifier: GPL-3.0-or-later
// Random poses on the preview head; `phiz bench torture` does the same with many more.
#include <gtest/gtest.h>

#include <cmath>

#include "phiz/anatomy/builtin/builtin_head.h"
#include "phiz/core/error.h"
#include "phiz/face/muscle_contraction.h"
#include "phiz/face/torture.h"
#include "phiz/face/volumetric_blendshapes.h"

namespace phiz {
namespace {

const FaceModel& model() {
  static const FaceModel instance = [] {
    BuiltinOptions options;
    options.size = HeadSize::preview;
    return build_volumetric_blendshapes(build_builtin_head(options));
  }();
  return instance;
}

void expect_survival(const TortureResult& result) {
  SCOPED_TRACE((result.beyond ? "beyond range, pose " : "pose ") + std::to_string(result.number) + ": " + result.what);
  EXPECT_EQ(result.error, "");
  EXPECT_TRUE(result.finite);
  EXPECT_TRUE(std::isfinite(result.statistics.residual));
  EXPECT_LT(result.penetration, 1e-4) << brief_report(result.statistics);
  if (result.statistics.converged) {
    EXPECT_LE(result.statistics.residual, TissueSolverOptions().residual_tolerance);
    EXPECT_LE(result.statistics.last_step, TissueSolverOptions().step_tolerance);
  }
}

TEST(Torture, RandomPosesWithinRangeConvergeAndKeepApart) {
  TortureOptions options;
  options.poses = 30;
  options.beyond = 0;
  int converged = 0;
  torture(model(), options, [&](const TortureResult& result) {
    expect_survival(result);
    converged += result.statistics.converged ? 1 : 0;
  });
  EXPECT_GE(converged, 27);
}

TEST(Torture, PosesBeyondRangeConvergeOrSayThatTheyDidNot) {
  TortureOptions options;
  options.poses = 0;
  options.beyond = 5;
  torture(model(), options, expect_survival);
}

TEST(Torture, TheNeutralFaceIsAtRest) {
  const std::vector<ActivationShape> shapes = estimate_activations(model(), head_tissue(model().head));
  MuscleSimulation simulation(model(), shapes);
  const SolveStatistics statistics = simulation.solve_static(VectorXd::Zero(static_cast<Eigen::Index>(shapes.size())));
  EXPECT_TRUE(statistics.converged) << brief_report(statistics);
  EXPECT_LT((simulation.positions() - model().head.volume.V).rowwise().norm().maxCoeff(), 1e-5);
}

TEST(Torture, APoseDependsOnItsNumberOnly) {
  const HeadTissue tissue = head_tissue(model().head);
  const PoseMaker a(model(), estimate_activations(model(), tissue), {}, 5), b = a;
  a.pose(3, false);
  const TorturePose once = a.pose(4, false), again = b.pose(4, false), beyond = a.pose(4, true);
  EXPECT_EQ(once.what, again.what);
  EXPECT_EQ(once.jaw, again.jaw);
  EXPECT_NE(once.what, beyond.what);
  EXPECT_TRUE((once.jaw.array() >= model().head.jaw.lower.array()).all());
  EXPECT_TRUE((once.jaw.array() <= model().head.jaw.upper.array()).all());
}

TEST(MuscleContraction, ShortensAlongTheFibresAndKeepsTheVolume) {
  const HeadTemplate& head = model().head;
  const HeadTissue tissue = head_tissue(head);
  const auto muscles = static_cast<Eigen::Index>(head.muscles.size());
  for (const Matrix3d& S : contract_muscles(head, tissue, VectorXd::Ones(muscles)))
    EXPECT_LT((S - Matrix3d::Identity()).norm(), 1e-12);
  const Muscle& muscle = head.muscles.front();
  std::vector<int> owners(static_cast<std::size_t>(head.volume.T.rows()), 0);
  for (const Muscle& m : head.muscles)
    for (const int t : m.tets) ++owners[static_cast<std::size_t>(t)];
  const std::vector<Matrix3d> stretches = contract_muscles(head, tissue, VectorXd::Constant(muscles, 0.7));
  int seen = 0;
  for (Eigen::Index t = 0; t < tissue.soft.size(); ++t)
    for (Eigen::Index i = 0; i < muscle.tets.size(); ++i) {
      if (muscle.tets[i] != tissue.soft[t] || owners[static_cast<std::size_t>(tissue.soft[t])] != 1) continue;
      const Vector3d d = muscle.direction.row(i);
      EXPECT_NEAR(d.dot(stretches[static_cast<std::size_t>(t)] * d), 0.7, 1e-6);
      EXPECT_NEAR(stretches[static_cast<std::size_t>(t)].determinant(), 1, 1e-6);
      ++seen;
    }
  EXPECT_GT(seen, 0);
  EXPECT_THROW(contract_muscles(head, tissue, VectorXd::Constant(muscles, 0.1)), Error);
  EXPECT_THROW(contract_muscles(head, tissue, VectorXd::Ones(muscles + 1)), Error);
}

}  // namespace
}  // namespace phiz
