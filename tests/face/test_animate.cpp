// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "face/small_face.h"
#include "phiz/core/error.h"
#include "phiz/face/animate.h"
#include "phiz/face/lid_closing.h"
#include "phiz/face/volumetric_blendshapes.h"

namespace phiz {
namespace {

const FaceModel& stiff_model() {
  static const FaceModel instance = [] {
    BlendshapeOptions options;  // stiffer than the default: the toy's sculpts lose more volume than those of heads
    options.volume = 100;
    options.hold = 30;
    options.inner_hold = 0.02;
    return build_volumetric_blendshapes(testing::small_head(), options);
  }();
  return instance;
}

void expect_same(const TakeFrame& a, const TakeFrame& b) {
  EXPECT_EQ((a.skin - b.skin).cwiseAbs().maxCoeff(), 0.0F);
  EXPECT_EQ((a.volume - b.volume).cwiseAbs().maxCoeff(), 0.0F);
  EXPECT_EQ(a.jaw, b.jaw);
  EXPECT_EQ(a.head.matrix(), b.head.matrix());
}

TEST(Animate, AnInterruptedRunResumesToTheIdenticalTake) {
  constexpr std::size_t length = key_interval + 8;
  const Performance performance = testing::small_performance(length);
  for (const bool dynamic : {false, true}) {
    AnimateOptions options;
    options.keep_volume = true;
    options.simulation.dynamic = dynamic;
    const Take whole = animate(stiff_model(), performance, options);
    ASSERT_EQ(whole.frames.size(), length);
    // Before the second key frame, just before it, after it, and with nothing left to do.
    for (const std::size_t stop : {std::size_t{5}, std::size_t{key_interval}, std::size_t{key_interval + 3}, length}) {
      std::vector<TakeFrame> frames;
      animate(stiff_model(), performance, options, {}, [&](const TakeFrame& frame, int) {
        frames.push_back(frame);
        return frames.size() < stop;
      });
      ASSERT_EQ(frames.size(), stop);
      std::vector<TakeFrame> finished(stop);  // nothing but what it takes to go on
      const int key = last_key_frame(static_cast<int>(stop));
      if (key > 0) finished[static_cast<std::size_t>(key) - 1] = frames[static_cast<std::size_t>(key) - 1];
      animate(stiff_model(), performance, options, finished, [&](const TakeFrame& frame, int number) {
        EXPECT_EQ(number, static_cast<int>(frames.size()));
        frames.push_back(frame);
        return true;
      });
      ASSERT_EQ(frames.size(), length);
      for (std::size_t f = 0; f < frames.size(); ++f) expect_same(frames[f], whole.frames[f]);
    }
  }
}

TEST(Animate, EveryFrameIsFreeOfPenetrationAndKeepsItsVolume) {
  const Take take = animate(stiff_model(), testing::small_performance(40));
  EXPECT_EQ(take.frames_planned, 40);
  int touching = 0;
  for (const TakeFrame& frame : take.frames) {
    EXPECT_LT(frame.statistics.penetration, 1e-4);
    EXPECT_LT(std::abs(frame.statistics.volume_change), 0.02);
    EXPECT_TRUE(frame.skin.allFinite());
    touching += frame.statistics.contacts > 0 ? 1 : 0;
  }
  EXPECT_GT(touching, 5);
}

TEST(Animate, ColumnsAreMatchedByNameAndTheRestIsReported) {
  const ExpressionMatch match = match_expressions(stiff_model(), testing::small_performance(3));
  EXPECT_EQ(match.column, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(match.unmatched, std::vector<std::string>{"browInnerUp"});
  EXPECT_TRUE(match.undriven.empty());
}

TEST(Animate, LipsAreClosedNoFartherThanTheJawIsOpen) {
  Performance performance = testing::small_performance(2);
  performance.expressions = {"mouthClose", "jawOpen", "a", "b"};
  performance.weights.row(0) << 0.9, 0.5, 0, 0;
  performance.weights.row(1) << 0.4, 0.5, 0, 0;
  const ExpressionMatch match{{0, 1}, {}, {}, {}};
  EXPECT_DOUBLE_EQ(shape_weights(match, performance, 0)[0], 0.65);
  EXPECT_DOUBLE_EQ(shape_weights(match, performance, 1)[0], 0.4);
  performance.expressions[1] = "c";
  EXPECT_DOUBLE_EQ(shape_weights(match, performance, 0)[0], 0.15);
}

TEST(Animate, LidsAreClosedNoFartherThanTheyAreOpen) {
  Performance performance = testing::small_performance(4);
  performance.expressions = {"eyeBlinkLeft", "eyeSquintLeft", "eyeWideLeft", "a"};
  performance.weights.row(0) << 1, 0, 0, 0;
  performance.weights.row(1) << 0.9, 1, 0, 0;
  performance.weights.row(2) << 0.9, 1, 1, 0;
  performance.weights.row(3) << 0.5, 1, 0, 0;
  ExpressionMatch match{{0, 1, 2}, {}, {}, {}};
  match.eyes.push_back({0, Vector3d(1, 0.4, -0.3)});
  EXPECT_DOUBLE_EQ(shape_weights(match, performance, 0)[0], 1.0);
  EXPECT_DOUBLE_EQ(shape_weights(match, performance, 1)[0], 0.7);  // 0.7 + 0.4: closed, and a tenth more
  EXPECT_DOUBLE_EQ(shape_weights(match, performance, 2)[0], 0.9);
  EXPECT_DOUBLE_EQ(shape_weights(match, performance, 3)[0], 0.5);
}

TEST(LidClosing, IsTheWayThatTheMarginsGoTowardsEachOther) {
  HeadTemplate head;
  head.skin.V.resize(10, 3);
  for (int i = 0; i < 5; ++i) {
    head.skin.V.row(i) << 0.01 * i, 0.010, 0;
    head.skin.V.row(5 + i) << 0.01 * i, 0, 0;
  }
  head.skin_regions["leftUpperLidMargin"] = VectorXi::LinSpaced(5, 0, 4);
  head.skin_regions["leftLowerLidMargin"] = VectorXi::LinSpaced(5, 5, 9);
  const auto add = [&head](const std::string& name, double upper, double lower) {
    Expression e{name, MatrixX3d::Zero(10, 3)};
    e.displacement.topRows(5).col(1).setConstant(upper);
    e.displacement.bottomRows(5).col(1).setConstant(lower);
    head.expressions.push_back(e);
  };
  add("eyeSquintLeft", -0.001, 0.003);
  EXPECT_EQ(lid_closing(head, "left").size(), 0) << "no blink";
  add("eyeBlinkLeft", -0.008, 0);
  add("eyeWideLeft", 0.002, 0);
  add("jawOpen", -0.004, -0.004);
  const VectorXd closing = lid_closing(head, "left");
  ASSERT_EQ(closing.size(), 4);
  EXPECT_NEAR(closing[0], 0.5, 1e-12);
  EXPECT_NEAR(closing[1], 1, 1e-12);
  EXPECT_NEAR(closing[2], -0.25, 1e-12);
  EXPECT_NEAR(closing[3], 0, 1e-12);
  EXPECT_EQ(lid_closing(head, "right").size(), 0) << "no margins";
}

TEST(Animate, EyeLookWeightsTurnTheEyesWhenNoAnglesWereRecorded) {
  Performance performance = testing::small_performance(2);
  performance.expressions = {"eyeLookOutLeft", "eyeLookInRight", "eyeLookUpLeft", "eyeLookUpRight"};
  performance.weights.row(0) << 1, 1, 0, 0;
  performance.weights.row(1) << 0, 0, 1, 1;
  const auto aside = eye_rotations(performance, 0);
  EXPECT_GT((aside.first * Vector3d::UnitZ()).x(), 0.3);  // both to the person's left
  EXPECT_GT((aside.second * Vector3d::UnitZ()).x(), 0.3);
  EXPECT_GT((eye_rotations(performance, 1).first * Vector3d::UnitZ()).y(), 0.3);
  performance.left_eye(0, 0) = -0.2;
  EXPECT_LT((eye_rotations(performance, 0).first * Vector3d::UnitZ()).x(), 0.0);
}

TEST(Animate, FramesOutsideOfThePerformanceAreRefused) {
  AnimateOptions options;
  options.first_frame = 5;
  EXPECT_THROW(animate(stiff_model(), testing::small_performance(3), options), Error);
}

TEST(Performance, ResamplingKeepsTheCurveAndTakesTheShorterArc) {
  Performance performance = testing::small_performance(31);
  performance.head(4, 0) = 3.1;
  performance.head(5, 0) = -3.1;
  const Performance twice = resample(performance, 60);
  EXPECT_EQ(twice.time.size(), 61);
  EXPECT_NEAR(twice.weights(9, 1), 0.5 * (performance.weights(4, 1) + performance.weights(5, 1)), 1e-12);
  EXPECT_NEAR(std::cos(twice.head(9, 0)), -1, 1e-3);
  EXPECT_LT((resample(performance, 30).weights - performance.weights).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Performance, WrongUnitsAndBrokenValuesAreRefused) {
  const Performance good = testing::small_performance(4);
  EXPECT_NO_THROW(validate(good, "x"));
  Performance bad = good;
  bad.weights(2, 0) = 80;
  EXPECT_THROW(validate(bad, "x"), Error);
  bad = good;
  bad.head(1, 1) = 30;
  EXPECT_THROW(validate(bad, "x"), Error);
  bad = good;
  bad.time[2] = bad.time[1];
  EXPECT_THROW(validate(bad, "x"), Error);
  bad = good;
  bad.weights(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(validate(bad, "x"), Error);
  bad = good;
  bad.left_eye.resize(1, 3);
  EXPECT_THROW(validate(bad, "x"), Error);
}

TEST(Performance, AnglesTurnAsDocumented) {
  EXPECT_GT((rotation_from_angles({0.3, 0, 0}) * Vector3d::UnitZ()).x(), 0);  // to the person's left
  EXPECT_LT((rotation_from_angles({0, 0.3, 0}) * Vector3d::UnitZ()).y(), 0);  // down
  EXPECT_LT((rotation_from_angles({0, 0, 0.3}) * Vector3d::UnitY()).x(), 0);  // top of the head to the person's right
}

TEST(Take, PartsGoWithTheirCarriers) {
  Take take;
  take.left_eye_centre = Vector3d(0.03, 0.03, 0.05);
  TakeFrame frame;
  frame.jaw[0] = 0.2;
  frame.head.translation() = Vector3d(1, 2, 3);
  frame.left_eye = Eigen::AngleAxisd(0.3, Vector3d::UnitY()).toRotationMatrix();
  const auto with = [&](Carrier carrier) { return part_transform(take, frame, {"p", {}, carrier, {}}); };
  EXPECT_EQ(with(Carrier::skull).matrix(), frame.head.matrix());
  EXPECT_LT((with(Carrier::mandible).matrix() - (frame.head * jaw_transform(take.joint, frame.jaw)).matrix()).norm(),
            1e-14);
  EXPECT_LT((with(Carrier::left_eye) * take.left_eye_centre - (frame.head * take.left_eye_centre)).norm(), 1e-14);
}

}  // namespace
}  // namespace phiz
