// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

#include "command.h"
#include "phiz/anatomy/expression_names.h"
#include "phiz/io/container.h"
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
    EXPECT_TRUE(a.frames[f].volume == b.frames[f].volume) << "frame " << f;
    EXPECT_TRUE(a.frames[f].velocity == b.frames[f].velocity) << "frame " << f;
    EXPECT_TRUE(a.frames[f].jaw == b.frames[f].jaw) << "frame " << f;
    EXPECT_TRUE(a.frames[f].head.matrix() == b.frames[f].head.matrix()) << "frame " << f;
    EXPECT_TRUE(a.frames[f].left_eye == b.frames[f].left_eye) << "frame " << f;
    EXPECT_EQ(a.frames[f].statistics.iterations, b.frames[f].statistics.iterations) << "frame " << f;
    EXPECT_EQ(a.frames[f].statistics.contacts, b.frames[f].statistics.contacts) << "frame " << f;
  }
}

TEST(Animate, SolvesEveryFrameOfThePerformance) {
  const Outcome outcome = phiz_command({"inspect", PHIZ_PREVIEW_TAKE, "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(nlohmann::json::parse(outcome.out).at("frames"), 300);
}

TEST(Animate, EveryExpressionAloneConvergesWithoutPenetrationOrLossOfVolume) {
  const ScratchFolder scratch;
  Performance performance;
  performance.expressions.assign(expression_names.begin(), expression_names.end());
  const auto count = static_cast<Eigen::Index>(expression_names.size());
  performance.weights = MatrixXd::Identity(count, count);
  performance.time = VectorXd::LinSpaced(count, 0, static_cast<double>(count - 1) / 30);
  performance.frame_rate = 30;
  performance.head = performance.left_eye = performance.right_eye = MatrixX3d::Zero(count, 3);
  save(scratch / "each.phiz", performance);
  const Outcome outcome =
      phiz_command({"animate", PHIZ_PREVIEW_MODEL, scratch / "each.phiz", "-o", scratch / "take.phiz", "--json", "-"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto report = nlohmann::json::parse(outcome.out);
  ASSERT_EQ(report.at("statistics").size(), expression_names.size());
  for (std::size_t e = 0; e < expression_names.size(); ++e) {
    const auto& frame = report.at("statistics").at(e);
    EXPECT_TRUE(frame.at("converged").get<bool>()) << expression_names[e];
    EXPECT_LE(frame.at("penetration_mm").get<double>(), 0.1) << expression_names[e];
    EXPECT_LE(std::abs(frame.at("volume_change").get<double>()), 0.02) << expression_names[e];
  }
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

const std::vector<std::string> plain_animate = {"animate", PHIZ_PREVIEW_MODEL, PHIZ_PERFORMANCE};

std::vector<std::string> with(std::vector<std::string> words, const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// Plays frames 20 to 140 into `take` and sends a signal as soon as the file there has reached some size.
Outcome stop_on_the_way(const std::vector<std::string>& command, const std::string& take, std::uintmax_t bytes,
                        int signal_number) {
  bool sent = false;
  Outcome stopped = phiz_command(with(command, {"-o", take, "--frames", "20:140"}), [&](pid_t child) {
    std::error_code none;
    const std::uintmax_t size = std::filesystem::file_size(take + ".part", none);
    if (sent || none || size <= bytes) return;
    ::kill(child, signal_number);
    sent = true;
  });
  EXPECT_TRUE(sent) << stopped.err;
  return stopped;
}

class Interrupted : public ::testing::TestWithParam<std::string> {};

TEST_P(Interrupted, ThenResumedEqualsUninterrupted) {
  const ScratchFolder scratch;
  const std::string take = scratch / "take.phiz", whole = scratch / "whole.phiz";
  const auto command = GetParam().empty() ? plain_animate : with(plain_animate, {GetParam()});
  const Outcome uninterrupted = phiz_command(with(command, {"-o", whole, "--frames", "20:140"}));
  ASSERT_EQ(uninterrupted.code, 0) << uninterrupted.err;

  ASSERT_EQ(phiz_command(with(command, {"-o", take, "--frames", "20:21"})).code, 0);
  const std::uintmax_t with_a_frame = std::filesystem::file_size(take), all = std::filesystem::file_size(whole);
  // Soon after the first frame, and before and after the later key frames.
  const std::vector<std::pair<int, std::uintmax_t>> stops = {{SIGINT, 0}, {SIGTERM, 22}, {SIGHUP, 46}, {SIGKILL, 60}};
  for (const auto& [signal_number, frames] : stops) {
    const std::uintmax_t bytes = with_a_frame + frames * (all - with_a_frame) / 119;
    const Outcome stopped = stop_on_the_way(command, take, bytes, signal_number);
    const bool killed = signal_number == SIGKILL;
    EXPECT_EQ(stopped.code, killed ? 128 + SIGKILL : 1) << stopped.err;
    EXPECT_EQ(stopped.err.find("--resume") == std::string::npos, killed) << stopped.err;
    {
      const TakeReader kept(killed ? take + ".part" : take);
      EXPECT_GT(kept.frames(), 0);
      EXPECT_LT(kept.frames(), 120);
      EXPECT_EQ(kept.head().frames_planned, 120);
    }
    const Outcome resumed = phiz_command(with(command, {"-o", take, "--frames", "20:140", "--resume"}));
    ASSERT_EQ(resumed.code, 0) << resumed.err;
    expect_same_frames(take, whole);
    EXPECT_FALSE(std::filesystem::exists(take + ".part"));
  }
}

TEST_P(Interrupted, KilledAgainAndAgainEqualsUninterrupted) {
  using Clock = std::chrono::steady_clock;
  const ScratchFolder scratch;
  const std::string take = scratch / "take.phiz", whole = scratch / "whole.phiz";
  auto command = with(plain_animate, {"--frames", "20:80", "--resume"});
  if (!GetParam().empty()) command.push_back(GetParam());
  const Clock::time_point start = Clock::now();
  ASSERT_EQ(phiz_command(with(command, {"-o", whole})).code, 0);
  const Clock::duration duration = Clock::now() - start;
  // At moments from the first to the last: while the model is read, at the first frames, while frames are copied or
  // played again, when the file is finished.
  constexpr int rounds = 12;
  for (int round = 0; round < rounds; ++round) {
    const Clock::time_point moment = Clock::now() + duration * (2 * round + 1) / (2 * rounds);
    const Outcome outcome = phiz_command(with(command, {"-o", take}), [&](pid_t child) {
      if (Clock::now() >= moment) ::kill(child, SIGKILL);
    });
    EXPECT_TRUE(outcome.code == 128 + SIGKILL || outcome.code == 0) << outcome.err;
  }
  const Outcome resumed = phiz_command(with(command, {"-o", take}));
  ASSERT_EQ(resumed.code, 0) << resumed.err;
  expect_same_frames(take, whole);
  EXPECT_FALSE(std::filesystem::exists(take + ".part"));
}

INSTANTIATE_TEST_SUITE_P(Animate, Interrupted, ::testing::Values("", "--dynamic"),
                         [](const ::testing::TestParamInfo<std::string>& parameter) {
                           return parameter.param.empty() ? "Static" : "Dynamic";
                         });

TEST(Animate, ATakeOfSomethingElseIsNotResumedAndStays) {
  const ScratchFolder scratch;
  const std::string take = scratch / "take.phiz";
  const std::vector<std::string> command = with(plain_animate, {"-o", take});
  ASSERT_EQ(phiz_command(with(command, {"--frames", "0:3"})).code, 0);
  const std::string bytes = read_text(take);
  const std::vector<std::pair<std::vector<std::string>, std::string>> others = {
      {{"--frames", "0:9"}, "3 frames, not 9"},
      {{"--frames", "60:63"}, "another performance"},
      {{"--frames", "0:3", "--dynamic"}, "without --dynamic"},
  };
  for (const auto& [words, reason] : others) {
    const Outcome outcome = phiz_command(with(with(command, words), {"--resume"}));
    EXPECT_EQ(outcome.code, 3) << outcome.err;
    EXPECT_NE(outcome.err.find(reason), std::string::npos) << outcome.err;
    EXPECT_TRUE(read_text(take) == bytes);
    EXPECT_FALSE(std::filesystem::exists(take + ".part"));
  }
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

}  // namespace
}  // namespace phiz::testing
