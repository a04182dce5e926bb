// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <signal.h>

#include <nlohmann/json.hpp>

#include "command.h"
#include "phiz/io/take_file.h"

namespace phiz::testing {
namespace {

/// The same physics to the last bit: everything but the time that it took.
void expect_same_frames(const std::string& left, const std::string& right) {
  const Take a = load_take(left);
  const Take b = load_take(right);
  ASSERT_EQ(a.frames.size(), b.frames.size());
  for (std::size_t f = 0; f < a.frames.size(); ++f) {
    EXPECT_EQ(a.frames[f].time, b.frames[f].time) << "frame " << f;
    EXPECT_TRUE(a.frames[f].skin == b.frames[f].skin) << "frame " << f;
    EXPECT_TRUE(a.frames[f].jaw == b.frames[f].jaw) << "frame " << f;
    EXPECT_EQ(a.frames[f].statistics.iterations, b.frames[f].statistics.iterations) << "frame " << f;
    EXPECT_EQ(a.frames[f].statistics.contacts, b.frames[f].statistics.contacts) << "frame " << f;
  }
}

TEST(Animate, SolvesEveryFrameOfThePerformance) {
  const Outcome outcome = phiz_command({"inspect", PHIZ_PREVIEW_TAKE, "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(nlohmann::json::parse(outcome.out).at("frames"), 300);
}

TEST(Animate, ReportsEveryFrameAsJson) {
  const ScratchFolder scratch;
  const Outcome outcome = phiz_command({"animate", PHIZ_PREVIEW_MODEL, PHIZ_PERFORMANCE, "-o", scratch / "take.phiz",
                                        "--frames", "30:40", "--json", "-"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto report = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(report.at("frames"), 10);
  ASSERT_EQ(report.at("statistics").size(), 10U);
  for (const auto& frame : report.at("statistics")) {
    EXPECT_TRUE(frame.at("converged").get<bool>()) << frame;
    EXPECT_LE(frame.at("penetration_mm").get<double>(), 0.1) << frame;
  }
}

TEST(Animate, InterruptedThenResumedEqualsUninterrupted) {
  const ScratchFolder scratch;
  const std::string take = scratch / "take.phiz";
  const std::vector<std::string> command = {"animate", PHIZ_PREVIEW_MODEL, PHIZ_PERFORMANCE, "-o",
                                            take,      "--frames",         "20:140"};
  // A take of one frame tells how long the file is when the first frames are in it.
  std::vector<std::string> single = command;
  single[6] = "20:21";
  ASSERT_EQ(phiz_command(single).code, 0);
  const std::uintmax_t with_a_frame = std::filesystem::file_size(take);

  bool sent = false;
  const Outcome stopped = phiz_command(command, [&](pid_t child) {
    std::error_code none;
    const std::uintmax_t size = std::filesystem::file_size(take + ".part", none);
    if (sent || none || size <= with_a_frame) return;
    ::kill(child, SIGINT);
    sent = true;
  });
  ASSERT_TRUE(sent) << stopped.err;
  EXPECT_EQ(stopped.code, 1) << stopped.err;
  EXPECT_NE(stopped.err.find("--resume"), std::string::npos) << stopped.err;
  const TakeReader kept(take);
  EXPECT_GT(kept.frames(), 0);
  EXPECT_LT(kept.frames(), 120);
  EXPECT_EQ(kept.head().frames_planned, 120);

  std::vector<std::string> resume = command;
  resume.push_back("--resume");
  const Outcome resumed = phiz_command(resume);
  ASSERT_EQ(resumed.code, 0) << resumed.err;

  std::vector<std::string> whole = command;
  whole[4] = scratch / "whole.phiz";
  const Outcome uninterrupted = phiz_command(whole);
  ASSERT_EQ(uninterrupted.code, 0) << uninterrupted.err;
  expect_same_frames(take, scratch / "whole.phiz");
}

TEST(Animate, GivesTheSameFramesForAnyNumberOfThreads) {
  const ScratchFolder scratch;
  for (const std::string threads : {"1", "2"}) {
    const Outcome outcome = phiz_command({"--threads", threads, "animate", PHIZ_PREVIEW_MODEL, PHIZ_PERFORMANCE, "-o",
                                          scratch / (threads + ".phiz"), "--frames", "40:60"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  expect_same_frames(scratch / "1.phiz", scratch / "2.phiz");
}

TEST(Animate, ResumingATakeOfAnotherLengthIsRefused) {
  const ScratchFolder scratch;
  const std::string take = scratch / "take.phiz";
  ASSERT_EQ(phiz_command({"animate", PHIZ_PREVIEW_MODEL, PHIZ_PERFORMANCE, "-o", take, "--frames", "0:3"}).code, 0);
  const Outcome outcome =
      phiz_command({"animate", PHIZ_PREVIEW_MODEL, PHIZ_PERFORMANCE, "-o", take, "--frames", "0:9", "--resume"});
  EXPECT_EQ(outcome.code, 3) << outcome.err;
}

}  // namespace
}  // namespace phiz::testing
