// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "phiz/core/measure.h"

namespace phiz {
namespace {

TEST(Measure, QuantilesAreAmongTheValues) {
  const std::vector<double> values = {5, 1, 4, 2, 3};
  EXPECT_EQ(quantile(values, 0), 1);
  EXPECT_EQ(quantile(values, 0.5), 3);
  EXPECT_EQ(quantile(values, 1), 5);
  EXPECT_EQ(quantile({}, 0.5), 0);
}

TEST(Measure, TimeAndMemoryOnlyGrow) {
  const Stopwatch watch;
  const double before = watch.milliseconds(), memory = peak_memory_mib();
  EXPECT_GE(watch.milliseconds(), before);
  EXPECT_GT(memory, 0);
  EXPECT_GE(peak_memory_mib(), memory);
}

}  // namespace
}  // namespace phiz
