// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <csignal>
#include <cstdio>

#include "phiz/core/progress.h"

namespace phiz {
namespace {

void interrupt_while_writing() {
  {
    const DelayInterrupts outer;
    const DelayInterrupts inner;
    std::raise(SIGINT);
    std::fputs("written", stderr);
  }
  std::fputs("not reached", stderr);
}

TEST(Interrupts, EndTheProcessAfterTheFileThatIsBeingWritten) {
  EXPECT_EXIT(interrupt_while_writing(), ::testing::KilledBySignal(SIGINT), "^written$");
}

void interrupt_what_asks() {
  catch_interrupts();
  { const DelayInterrupts delay; }
  std::raise(SIGINT);
  std::fputs(interrupted() ? "told" : "not told", stderr);
  std::raise(SIGINT);
}

TEST(Interrupts, AreToldOnceToWorkThatAsksForThem) {
  EXPECT_EXIT(interrupt_what_asks(), ::testing::KilledBySignal(SIGINT), "^told$");
}

}  // namespace
}  // namespace phiz
