// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "io/expect_error.h"
#include "io/temporary_folder.h"
#include "phiz/anatomy/expression_names.h"
#include "phiz/io/live_link.h"
#include "phiz/io/timecode.h"

namespace phiz {
namespace {

int column(std::string_view name) {
  for (std::size_t i = 0; i < expression_names.size(); ++i) {
    if (expression_names[i] == name) return static_cast<int>(i);
  }
  return -1;
}

TEST(LiveLink, columns_are_matched_by_name_in_any_spelling) {
  const auto recording = parse_live_link(
      "\xEF\xBB\xBF\"mouthSmile_R\",JAWOPEN,jawL,Timecode,HeadYaw,extra\r\n"
      "0.1,0.2,0.3,01:00:00:59.000,0.5,9\r\n\r\n\"0.4\",0.5,0.6,01:00:01:00.000,0.5,9\r\n",
      "a.csv");
  const Performance& p = recording.performance;
  EXPECT_EQ(p.weights(0, column("mouthSmileRight")), 0.1);
  EXPECT_EQ(p.weights(1, column("jawOpen")), 0.5);
  EXPECT_EQ(p.weights(1, column("jawLeft")), 0.6);
  EXPECT_EQ(p.weights(1, column("jawRight")), 0);
  EXPECT_EQ(p.head(0, 0), -0.5);  // the recorder's yaw is positive to the person's right
  EXPECT_EQ(p.expressions.size(), 52u);
  ASSERT_EQ(recording.notes.size(), 2u);
  EXPECT_NE(recording.notes[0].find("eyeBlinkLeft"), std::string::npos);
  EXPECT_NE(recording.notes[1].find("'extra'"), std::string::npos);
}

TEST(LiveLink, what_is_written_reads_back_the_same) {
  const TemporaryFolder folder;
  Performance p;
  p.expressions = {"jawOpen", "browInnerUp"};
  p.frame_rate = 30;
  p.time = VectorXd::LinSpaced(90, 0, 89.0 / 30);
  p.weights = MatrixXd::Random(90, 2).cwiseAbs();
  p.head = MatrixX3d::Random(90, 3);
  p.left_eye = MatrixX3d::Random(90, 3) * 0.2;
  p.right_eye = MatrixX3d::Random(90, 3) * 0.2;
  write_live_link(folder.file("a.csv"), p);
  const auto back = read_live_link(folder.file("a.csv"));
  EXPECT_TRUE(back.notes.empty());
  EXPECT_EQ(back.performance.frame_rate, 30);
  EXPECT_LT((back.performance.time - p.time).cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_LT((back.performance.weights.col(column("browInnerUp")) - p.weights.col(1)).norm(), 1e-7);
  EXPECT_LT((back.performance.head - p.head).norm(), 1e-7);
  EXPECT_LT((back.performance.right_eye - p.right_eye).norm(), 1e-7);
}

TEST(LiveLink, seconds_and_no_time_at_all_are_understood) {
  const auto seconds = parse_live_link("time;jawOpen\n10,5;0\n10,54;1\n10,58;0,5\n", "a.csv").performance;
  EXPECT_NEAR(seconds.time[2], 0.08, 1e-12);
  EXPECT_EQ(seconds.frame_rate, 25);
  EXPECT_EQ(seconds.weights(2, column("jawOpen")), 0.5);
  const auto none = parse_live_link("jawOpen\n0\n1\n", "a.csv").performance;
  EXPECT_NEAR(none.time[1], 1.0 / 60, 1e-12);
}

TEST(LiveLink, milliseconds_and_times_of_day_are_understood) {
  const auto milliseconds = parse_live_link("timestamp_ms,jawOpen\n1000,0\n1033,1\n1067,0\n", "a.csv").performance;
  EXPECT_NEAR(milliseconds.time[2], 0.067, 1e-12);
  EXPECT_EQ(milliseconds.frame_rate, 30);
  const auto clock = parse_live_link("Time,jawOpen\n23:59:59.96,0\n24:00:00,1\n0:00:00.04,0\n", "a.csv").performance;
  EXPECT_NEAR(clock.time[2], 0.08, 1e-9);
  EXPECT_EQ(clock.frame_rate, 25);
  // A time code says more than seconds, seconds more than milliseconds, wherever they stand.
  const auto both = parse_live_link("ms,time [s],jawOpen\n7,0,0\n7,0.5,1\n", "a.csv").performance;
  EXPECT_EQ(both.time[1], 0.5);
}

TEST(LiveLink, frames_without_a_face_are_left_out_with_a_note) {
  const auto recording = parse_live_link(
      "Timecode,BlendShapeCount,JawOpen,HeadYaw\n00:00:00:00.0,0\n00:00:00:01.0,0,,\n00:00:00:02.0,61,0.5,0.1\n"
      "00:00:00:03.0,61,,\n00:00:00:04.0,61,0.7,0.1\n",
      "a.csv");
  ASSERT_EQ(recording.performance.time.size(), 2);
  EXPECT_NEAR(recording.performance.time[1], 2.0 / 60, 1e-9);
  EXPECT_EQ(recording.performance.weights(1, column("jawOpen")), 0.7);
  EXPECT_NE(recording.notes.back().find("3 frames in which no face was seen"), std::string::npos);
  EXPECT_REJECTED(parse_live_link("Timecode,BlendShapeCount,JawOpen\n00:00:00:00.0,0\n", "a.csv"), "no face");
  EXPECT_REJECTED(parse_live_link("time,jawOpen,headYaw\n0,,0\n", "a.csv"), "finite number, found ''");
}

TEST(LiveLink, spreadsheets_of_all_countries_are_understood) {
  for (const char* text : {"sep=;\r\ntime;jawOpen\r\n0;0\r\n0,02;0,5\r\n", "time\tjawOpen\n0\t0\n0,02\t0,5\n",
                           "time,jawOpen,\n0,0,\n\"0,02\",\"0,5\"\n", "\xEF\xBB\xBFtime,jawOpen\r0,0\r0.02,.5\r"}) {
    const Performance p = parse_live_link(text, "a.csv").performance;
    ASSERT_EQ(p.time.size(), 2) << text;
    EXPECT_EQ(p.time[1], 0.02) << text;
    EXPECT_EQ(p.weights(1, column("jawOpen")), 0.5) << text;
  }
  const auto codes = parse_live_link("Timecode;jawOpen\n0:0:0:0,5;0\n0:0:0:1,5;1\n", "a.csv").performance;
  EXPECT_NEAR(codes.time[1], 1.0 / 60, 1e-12);
  EXPECT_REJECTED(parse_live_link("time,jawOpen\n0,00,0,5\n", "a.csv"), "decimal comma");
}

TEST(LiveLink, repeated_frames_are_left_out_with_a_note) {
  const auto recording = parse_live_link("time,jawOpen\n0,0\n0.02,1\n0.02,1\n0.04,0\n", "a.csv");
  EXPECT_EQ(recording.performance.time.size(), 3);
  EXPECT_EQ(recording.performance.weights.rows(), 3);
  EXPECT_NE(recording.notes.back().find("repeat"), std::string::npos);
}

TEST(LiveLink, names_the_line_of_what_is_wrong) {
  EXPECT_REJECTED(parse_live_link("time,jawOpen\n0,0\n1,x\n", "a.csv"), "a.csv:3");
  EXPECT_REJECTED(parse_live_link("time,jawOpen\n0,nan\n", "a.csv"), "finite");
  EXPECT_REJECTED(parse_live_link("time,jawOpen\n0\n", "a.csv"), "1 fields, expected 2");
  EXPECT_REJECTED(parse_live_link("time,jawOpen\n1,0\n0,0\n", "a.csv"), "backward");
  EXPECT_REJECTED(parse_live_link("time,jawOpen\n0,78\n", "a.csv"), "percent");
  EXPECT_REJECTED(parse_live_link("time,jawOpen,headYaw\n0,0,15\n", "a.csv"), "degrees");
  EXPECT_REJECTED(parse_live_link("time,jawOpen,jaw_open\n0,0,0\n", "a.csv"), "twice");
  EXPECT_REJECTED(parse_live_link("Timecode,jawOpen\nx,0\n", "a.csv"), "time code");
  EXPECT_REJECTED(parse_live_link("a,b\n0,0\n", "a.csv"), "no column");
  EXPECT_REJECTED(parse_live_link("time,jawOpen\n", "a.csv"), "no frames");
  EXPECT_REJECTED(parse_live_link("time,\"jawOpen\n", "a.csv"), "not closed");
  EXPECT_REJECTED(parse_live_link("time,jawOpen\n0,0\n33,0\n67,0\n", "a.csv"), "divide milliseconds by 1000");
  EXPECT_REJECTED(parse_live_link(std::string_view("\xff\xfeJ\0", 4), "a.csv"), "UTF-8");
}

TEST(LiveLink, weights_beyond_0_to_1_are_played_with_a_note) {
  const auto recording = parse_live_link("time,jawOpen\n0,-0.5\n0.1,1.5\n", "a.csv");
  EXPECT_EQ(recording.performance.weights(1, column("jawOpen")), 1.5);
  EXPECT_NE(recording.notes.back().find("from -0.5 to 1.5"), std::string::npos) << recording.notes.back();
}

std::vector<Timecode> recorded(double rate, double start, int frames, int step = 1) {
  std::vector<Timecode> codes;
  for (int i = 0; i < frames; ++i) {
    const double t = start + i * step;
    const double seconds = std::floor(t / rate);
    codes.push_back({static_cast<long long>(seconds), t - seconds * rate});
  }
  return codes;
}

TEST(Timecode, the_rate_is_found_from_the_frames) {
  for (const double rate : {24.0, 25.0, 30.0, 48.0, 50.0, 60.0, 120.0}) {
    EXPECT_EQ(timecode_rate(recorded(rate, 7.25, static_cast<int>(3 * rate))), rate);
  }
  EXPECT_EQ(timecode_rate(recorded(60, 3, 100, 2)), 60);  // every other frame
  EXPECT_EQ(timecode_rate(recorded(60, 10, 20)), 60);     // within one second
}

TEST(Timecode, hours_may_pass_midnight_either_way) {
  const auto beyond = parse_timecode("24:53:15:35.121");
  ASSERT_TRUE(beyond);
  EXPECT_EQ(beyond->seconds, 24 * 3600 + 53 * 60 + 15);
  EXPECT_DOUBLE_EQ(beyond->frames, 35.121);
  std::vector<Timecode> codes = {*parse_timecode("23:59:59:59.0"), *parse_timecode("00:00:00:00.0")};
  EXPECT_NEAR(timecode_seconds(codes, 60)[1], 1.0 / 60, 1e-9);
  codes = {*parse_timecode("24:59:59:59.0"), *parse_timecode("01:00:00:00.0")};
  EXPECT_NEAR(timecode_seconds(codes, 60)[1], 1.0 / 60, 1e-9);
}

TEST(Timecode, what_is_none_is_refused) {
  for (const char* text :
       {"", "1:2:3", "1:2:3.5:4", "1:60:0:0", "a:b:c:d", "1:2:3:-4", "1:2:3:nan", "1:2:3:120", "1:2:3:4:5"}) {
    EXPECT_FALSE(parse_timecode(text)) << text;
  }
  EXPECT_EQ(format_timecode(3600 + 59.99999999, 60), "01:01:00:00.000");
}

}  // namespace
}  // namespace phiz
