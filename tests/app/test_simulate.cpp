// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "command.h"
#include "phiz/io/take_file.h"

namespace phiz::testing {
namespace {

const std::vector<std::string> plain_simulate = {"simulate", PHIZ_PREVIEW_MODEL};

std::vector<std::string> with(std::vector<std::string> words, const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// A cube of 40 mm about its origin.
const char* const cube =
    "v -0.02 -0.02 -0.02\nv 0.02 -0.02 -0.02\nv -0.02 0.02 -0.02\nv 0.02 0.02 -0.02\n"
    "v -0.02 -0.02 0.02\nv 0.02 -0.02 0.02\nv -0.02 0.02 0.02\nv 0.02 0.02 0.02\n"
    "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

TEST(Simulate, PlaysAPerformanceWithInertiaAndReportsFramesAndIterations) {
  const ScratchFolder scratch;
  const std::string take = scratch / "take.phiz", table = scratch / "trace.csv";
  const Outcome outcome = phiz_command(
      with(plain_simulate, {PHIZ_PERFORMANCE, "-o",  take,     "--frames", "30:33",  "--dynamic", "--damping", "2",
                            "--time-step",    "8",   "--wind", "0,0,-10",  "--gust", "0.5,0.4",   "--gravity", "0,-1,0",
                            "--trace",        table, "--json", "-"}));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto report = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(report.at("frames"), 3);
  EXPECT_EQ(report.at("frames_planned"), 3);
  EXPECT_EQ(report.at("dynamic"), true);
  ASSERT_EQ(report.at("statistics").size(), 3U);
  EXPECT_EQ(report.at("statistics").at(0).at("frame"), 30);
  for (const auto& frame : report.at("statistics")) {
    EXPECT_TRUE(frame.at("converged").get<bool>()) << frame;
    EXPECT_LE(frame.at("penetration_mm").get<double>(), 0.1) << frame;
  }
  const Take made = load_take(take);
  ASSERT_EQ(made.frames.size(), 3U);
  EXPECT_GT(made.frames[2].velocity.rowwise().norm().maxCoeff(), 0);
  const std::string text = read_text(table);
  EXPECT_EQ(text.rfind("frame,iteration,round,energy_j,residual,contacts,violation_mm,step_share,step_mm,ms\n30,", 0),
            0U);
  EXPECT_NE(text.find("\n32,"), std::string::npos);
  EXPECT_EQ(phiz_command({"inspect", take}).code, 0);
}

TEST(Simulate, ShowsAnExpressionWithoutAPerformance) {
  const ScratchFolder scratch;
  const std::string smile = scratch / "smile.phiz", half = scratch / "half.phiz";
  const std::vector<std::string> weights = {"--weights", "mouthSmileLeft=1,mouthSmileRight=1"};
  ASSERT_EQ(phiz_command(with(with(plain_simulate, weights), {"-o", smile})).code, 0);
  const Take whole = load_take(smile);
  ASSERT_EQ(whole.frames.size(), 1U);
  const Outcome outcome =
      phiz_command(with(with(plain_simulate, weights), {"-o", half, "--seconds", "0.1", "--fps", "30", "--ramp", "0.05",
                                                        "--paralyse", "left,procerus", "--tolerance", "0.02"}));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Take paralysed = load_take(half);
  ASSERT_EQ(paralysed.frames.size(), 3U);
  // How far the skin of either half goes.
  const auto moved = [](const Take& take, double side) {
    const MatrixX3d move = take.frames.back().skin.cast<double>() - take.skin.V;
    double most = 0;
    for (Eigen::Index v = 0; v < move.rows(); ++v)
      if (side * take.skin.V(v, 0) > 0.02) most = std::max(most, move.row(v).norm());
    return most;
  };
  EXPECT_NEAR(moved(whole, 1), moved(whole, -1), 0.2 * moved(whole, 1));
  EXPECT_LT(moved(paralysed, 1), 0.5 * moved(paralysed, -1));
}

TEST(Simulate, KeepsSkinOutOfAnObjectThatCanBeSeenBesideTheTake) {
  const ScratchFolder scratch;
  write_text(scratch / "cube.obj", cube);
  write_text(scratch / "path.csv", "time,x,y,z\n-0.2,0,0,0.16\n0,0,0,0.112\n");
  const std::vector<std::string> object = {"--object",           scratch / "cube.obj", "--object-path",
                                           scratch / "path.csv", "--object-frame",     "head"};
  const Outcome outcome = phiz_command(
      with(with(plain_simulate, {"--weights", "jawOpen=0.2", "-o", scratch / "take.phiz", "--json", "-"}), object));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto frame = nlohmann::json::parse(outcome.out).at("statistics").at(0);
  EXPECT_GT(frame.at("contacts").get<int>(), 0);
  EXPECT_LE(frame.at("penetration_mm").get<double>(), 0.1);
  const Outcome picture = phiz_command(with(
      {"render", scratch / "take.phiz", "-o", scratch / "nose.png", "--size", "64x64", "--quality", "draft"}, object));
  EXPECT_EQ(picture.code, 0) << picture.err;
  const Outcome inside = phiz_command(
      with(plain_simulate, {"-o", scratch / "in.phiz", "--object", scratch / "cube.obj", "--object-at", "0,0,0.1"}));
  EXPECT_EQ(inside.code, 3);
  EXPECT_NE(inside.err.find("reaches into the head"), std::string::npos) << inside.err;
  EXPECT_FALSE(std::filesystem::exists(scratch / "in.phiz"));
}

TEST(Simulate, KeepsFinishedFramesWhenInterrupted) {
  const ScratchFolder scratch;
  const std::string take = scratch / "take.phiz";
  bool sent = false;
  const Outcome outcome =
      phiz_command(with(plain_simulate, {PHIZ_PERFORMANCE, "-o", take, "--dynamic"}), [&](pid_t child) {
        std::error_code none;
        const auto size = std::filesystem::file_size(take + ".part", none);
        if (sent || none || size < 4'000'000) return;
        ::kill(child, SIGINT);
        sent = true;
      });
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.err.find("cannot be resumed"), std::string::npos) << outcome.err;
  const TakeReader kept(take);
  EXPECT_GT(kept.frames(), 0);
  EXPECT_LT(kept.frames(), 300);
}

TEST(Simulate, RefusesMistakesOfTheCommandLine) {
  const ScratchFolder scratch;
  write_text(scratch / "cube.obj", cube);
  const std::string out = scratch / "take.phiz";
  const std::vector<std::pair<std::vector<std::string>, std::string>> mistakes = {
      {{"--weights", "jawOpn=1"}, "did you mean 'jawOpen'"},
      {{"--weights", "jawOpen=much"}, "NAME=WEIGHT"},
      {{PHIZ_PERFORMANCE, "--weights", "jawOpen=1"}, "one or the other"},
      {{PHIZ_PERFORMANCE, "--seconds", "1"}, "one or the other"},
      {{PHIZ_PERFORMANCE, "--frames", "290:310"}, "there are 300 frames"},
      {{"--wind", "1,2"}, "X,Y,Z"},
      {{"--gravity", "0,down,0"}, "X,Y,Z"},
      {{"--gust", "0.5,1"}, "--gust needs --wind"},
      {{"--wind", "1,0,0", "--gust", "0.5"}, "SHARE,PERIOD"},
      {{"--damping", "3"}, "need --dynamic"},
      {{"--tolerance", "0"}, "--tolerance"},
      {{"--passive", "rubber"}, "--passive"},
      {{"--object-at", "0,0,0"}, "need --object"},
      {{"--object", scratch / "cube.obj", "--no-contact"}, "needs contact"},
      {{"--paralyse", "zygomaticusMajr"}, "did you mean zygomaticusMajor"},
      {{"--trace", PHIZ_PREVIEW_MODEL}, "one of the files that are read"},
      {{"--damp", "3"}, "no option '--damp'"},
  };
  for (const auto& [words, message] : mistakes) {
    const Outcome outcome = phiz_command(with(with(plain_simulate, words), {"-o", out}));
    EXPECT_EQ(outcome.code, 2) << words.back() << ": " << outcome.err;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << message << " is not in: " << outcome.err;
  }
  EXPECT_EQ(phiz_command({"simulate", PHIZ_PREVIEW_MODEL, "-o", PHIZ_PREVIEW_MODEL}).code, 2);
}

TEST(Simulate, RefusesMalformedFiles) {
  const ScratchFolder scratch;
  write_text(scratch / "open.obj", std::string(cube).substr(0, std::string(cube).rfind("f ")));
  write_text(scratch / "cube.obj", cube);
  write_text(scratch / "huge.obj", "v -9 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  write_text(scratch / "path.csv", "time,x,y\n0,0,0\n");
  const std::vector<std::pair<std::vector<std::string>, std::string>> files = {
      {{"--object", scratch / "open.obj"}, "open.obj"},
      {{"--object", scratch / "huge.obj"}, "metres"},
      {{"--object", scratch / "none.obj"}, "none.obj"},
      {{"--object", scratch / "cube.obj", "--object-path", scratch / "path.csv"}, "column z is missing"},
      {{"--head-path", scratch / "path.csv"}, "column z is missing"},
      {{PHIZ_PREVIEW_MODEL}, "performance"},
  };
  for (const auto& [words, message] : files) {
    const Outcome outcome = phiz_command(with(with(plain_simulate, words), {"-o", scratch / "take.phiz"}));
    EXPECT_EQ(outcome.code, 3) << words.back() << ": " << outcome.err;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << message << " is not in: " << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(scratch / "take.phiz"));
  }
}

}  // namespace
}  // namespace phiz::testing
