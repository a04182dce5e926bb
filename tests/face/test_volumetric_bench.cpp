// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "face/small_face.h"
#include "phiz/face/volumetric_bench.h"
#include "phiz/face/volumetric_blendshapes.h"

namespace phiz {
namespace {

TEST(VolumetricBench, AnIndependentSolverReachesTheSameStates) {
  const FaceModel model = build_volumetric_blendshapes(testing::small_head());
  VolumetricBenchOptions options;
  options.frames = 30;
  options.reference_frames = 6;
  options.thread_scaling = false;
  options.simulation.solve.step_tolerance = 1e-6;  // lips pressed hard creep on for long
  options.simulation.solve.max_iterations = 100;
  const VolumetricBench bench = bench_volumetric(model, testing::small_performance(30), options);
  EXPECT_EQ(bench.frames, 30);
  EXPECT_EQ(bench.ms.size(), 29U);
  ASSERT_TRUE(bench.skin_error_mm_max.has_value());
  EXPECT_TRUE(bench.reference_converged);
  EXPECT_LT(*bench.skin_error_mm_max, 0.05);
  EXPECT_LT(bench.penetration_mm_max, 0.1);
  EXPECT_GT(bench.contacts_max, 0);
  EXPECT_GT(bench.peak_rss_mib, 1);
}

TEST(VolumetricBench, TheMadeUpPerformanceIsValidAndDoesNotDependOnItsLength) {
  const Performance a = bench_performance(60), b = bench_performance(20);
  EXPECT_NO_THROW(validate(a, "bench"));
  EXPECT_EQ(a.weights.topRows(20), b.weights);
}

}  // namespace
}  // namespace phiz
