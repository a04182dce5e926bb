// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>

#include "face/small_face.h"
#include "phiz/core/error.h"
#include "phiz/elasticity/tissue_newton.h"
#include "phiz/face/forward_bench.h"
#include "phiz/face/volumetric_blendshapes.h"

namespace phiz {
namespace {

/// The small face with a muscle along both lips.
FaceModel small_muscle_face() {
  HeadTemplate head = testing::small_head();
  Muscle muscle;
  muscle.name = "orbicularisOris";
  muscle.tets = VectorXi::LinSpaced(head.volume.T.rows(), 0, static_cast<int>(head.volume.T.rows()) - 1);
  muscle.fraction = VectorXd::Constant(muscle.tets.size(), 0.4);
  muscle.direction = Vector3d::UnitX().transpose().replicate(muscle.tets.size(), 1);
  head.muscles.push_back(muscle);
  return build_volumetric_blendshapes(head);
}

ForwardBenchOptions few_frames() {
  ForwardBenchOptions options;
  options.frames = 12;
  options.reference_frames = 4;
  options.own_start_frames = options.rival_frames = 2;
  options.scaling_frames = 4;
  options.simulation.tissue.muscle_stiffness = 2;
  return options;
}

TEST(ForwardBench, JudgesTheRealTimeEngineByTheReference) {
  const FaceModel model = small_muscle_face();
  const ForwardBench bench = bench_forward(model, testing::small_performance(12), few_frames());
  EXPECT_EQ(bench.frames, 12);
  EXPECT_EQ(bench.times.ms.size(), 11U);
  EXPECT_EQ(bench.residual.size(), 12U);
  EXPECT_EQ(bench.times.not_converged, 0);
  EXPECT_EQ(bench.reference.size(), 4U);
  EXPECT_TRUE(bench.reference_converged());
  EXPECT_LT(bench.skin_error_mm_max().value(), 0.05);
  EXPECT_LT(bench.skin_error_own_start_mm_max().value(), 0.05);
  EXPECT_LT(*std::max_element(bench.penetration_mm.begin(), bench.penetration_mm.end()), 0.1);
  EXPECT_EQ(bench.dynamic.ms.size(), 11U);
  EXPECT_GT(bench.factorisations, 0);
  EXPECT_GT(bench.peak_rss_mib, 1);
  ASSERT_EQ(bench.dial.size(), 3U);
  EXPECT_LE(bench.dial[2].skin_error_mm_max.value(), bench.dial[0].skin_error_mm_max.value() + 1e-3);
  EXPECT_FALSE(bench.rival_ratio().has_value());
  EXPECT_FALSE(bench.fine_ratio().has_value());
}

TEST(ForwardBench, ARivalThatIsTheReferenceAgreesWithIt) {
  const FaceModel model = small_muscle_face();
  ForwardBenchOptions options = few_frames();
  options.dial.clear();
  options.dynamic_step_tolerance = options.scaling_frames = 0;
  options.fine = [&model] { return model; };
  options.rival = [](const TissueEnergy& energy, MatrixX3d& x, ContactScene* contacts, Trace* trace) {
    NewtonStaticOptions how;
    how.trace = trace;
    return solve_static(energy, x, how, contacts);
  };
  const ForwardBench bench = bench_forward(model, testing::small_performance(12), options);
  ASSERT_EQ(bench.rival.size(), 2U);
  EXPECT_TRUE(bench.rival_converged());
  EXPECT_LT(bench.rival[1].skin_error_mm, 0.01);
  EXPECT_GT(bench.rival_ratio().value(), 0);
  EXPECT_EQ(bench.fine_soft_tets, bench.soft_tets);
  EXPECT_GT(bench.fine_ratio().value(), 0);
  EXPECT_FALSE(bench.thread_scaling.has_value());
  for (const char* engine : {"real-time", "reference", "rival"})
    EXPECT_EQ(std::count_if(bench.traces.begin(), bench.traces.end(),
                            [&](const EngineTrace& trace) { return trace.engine == engine; }),
              2)
        << engine;
}

TEST(ForwardBench, RefusesAPerformanceWithoutFrames) {
  EXPECT_THROW(bench_forward(small_muscle_face(), testing::small_performance(0), few_frames()), Error);
}

}  // namespace
}  // namespace phiz
