// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "phiz/core/parallel.h"

namespace phiz {
namespace {

TEST(ParallelFor, VisitsEveryItemOnce) {
  std::vector<int> visits(10007, 0);
  parallel_for(
      std::ssize(visits), [&](std::ptrdiff_t i) { ++visits[static_cast<std::size_t>(i)]; }, 13);
  for (const int count : visits) EXPECT_EQ(count, 1);
}

TEST(ParallelFor, DoesNothingForAnEmptyRange) {
  parallel_for(0, [](std::ptrdiff_t) { FAIL(); });
}

TEST(ParallelFor, PassesExceptionsOn) {
  EXPECT_THROW(parallel_for(
                   1000,
                   [](std::ptrdiff_t i) {
                     if (i == 500) throw std::runtime_error("item 500");
                   },
                   10),
               std::runtime_error);
}

TEST(ParallelSum, HasTheSameBitsForAnyNumberOfThreads) {
  const auto sum = [] {
    return parallel_sum(100000, 64, [](std::ptrdiff_t begin, std::ptrdiff_t end) {
      double s = 0;
      for (std::ptrdiff_t i = begin; i < end; ++i) s += std::sin(static_cast<double>(i)) * 1e-3;
      return s;
    });
  };
  const double many = sum();
  const ThreadLimit one(1);
  EXPECT_EQ(thread_count(), 1);
  EXPECT_EQ(many, sum());
}

}  // namespace
}  // namespace phiz
