// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

#include "phiz/core/background.h"
#include "phiz/core/parallel.h"

namespace phiz {
namespace {

TEST(Background, GivesItsResultOnce) {
  Background work;
  for (const bool expected : {true, false}) {
    work.start([expected] { return expected; });
    EXPECT_TRUE(work.is_started());
    EXPECT_EQ(work.get(), expected);
    EXPECT_FALSE(work.is_started());
  }
}

TEST(Background, PassesExceptionsOn) {
  Background work;
  work.start([]() -> bool { throw std::runtime_error("no"); });
  EXPECT_THROW(work.get(), std::runtime_error);
}

TEST(Background, IsDoneOrNeverBegunAfterItWasDropped) {
  for (int round = 0; round < 200; ++round) {
    std::atomic<int> begun{0}, ended{0};
    {
      Background work;
      work.start([&] {
        ++begun;
        ++ended;
        return true;
      });
    }
    EXPECT_EQ(begun, ended);
  }
}

TEST(Background, ComesToAnEndWhereAllThreadsWaitForIt) {
  std::atomic<int> done{0};
  for (const int threads : {0, 1}) {
    const ThreadLimit limit(threads);
    parallel_for(
        64,
        [&](std::ptrdiff_t) {
          Background work;
          work.start([] { return true; });
          done += work.get() ? 1 : 0;
        },
        1);
  }
  EXPECT_EQ(done, 128);
}

}  // namespace
}  // namespace phiz
