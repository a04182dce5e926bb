// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "command.h"
#include "phiz/io/live_link.h"

namespace phiz::testing {
namespace {

TEST(DemoPerformance, IsWhatItsAuthorWrites) {
  const ScratchFolder scratch;
  const Outcome outcome = run_program({PHIZ_AUTHOR, scratch / "again.csv"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(read_text(scratch / "again.csv") == read_text(PHIZ_PERFORMANCE));
}

TEST(DemoPerformance, MovesSmoothlyAndReturnsToRest) {
  const Performance performance = read_live_link(PHIZ_PERFORMANCE).performance;
  ASSERT_EQ(performance.weights.rows(), 300);
  EXPECT_EQ(performance.frame_rate, 30);
  const auto frames = performance.weights.rows();
  EXPECT_GE(performance.weights.minCoeff(), 0);
  EXPECT_LE(performance.weights.maxCoeff(), 1);
  EXPECT_LT(performance.weights.row(0).maxCoeff(), 0.05);
  EXPECT_LT(performance.weights.row(frames - 1).maxCoeff(), 0.1);
  for (Eigen::Index e = 0; e < performance.weights.cols(); ++e) {
    const bool lids =
        performance.expressions[static_cast<std::size_t>(e)].rfind("eye", 0) == 0;  // blinks and saccades are fast
    const auto step = performance.weights.col(e).tail(frames - 1) - performance.weights.col(e).head(frames - 1);
    EXPECT_LT(step.cwiseAbs().maxCoeff(), lids ? 0.75 : 0.35) << performance.expressions[static_cast<std::size_t>(e)];
  }
  const auto turn = performance.head.bottomRows(frames - 1) - performance.head.topRows(frames - 1);
  EXPECT_LT(turn.cwiseAbs().maxCoeff(), 0.05);
}

}  // namespace
}  // namespace phiz::testing
