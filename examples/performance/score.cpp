// SPDX-License-Identifier: GPL-3.0-or-later
#include "score.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "curves.h"
#include "phiz/anatomy/expression_names.h"
#include "speech.h"

namespace phiz::authoring {

namespace {

constexpr double length = 10.0;  // seconds
constexpr double degree = std::numbers::pi / 180;
constexpr double full_gaze = 30 * degree;  // eye angle at which an eyeLook weight is 1

/// To the precision that a recorder keeps; also turns -0 into 0.
double recorded(double value) {
  return std::round(value * 1e5) / 1e5 + 0.0;
}

/// "Hello. I am made of flesh and bone."
std::vector<Sound> spoken() {
  return sentence({"h", "e",  "l", "o", "u", "_", "a",  "i",  "ae", "m", "m", "e", "i",
                   "d", "uh", "v", "f", "l", "e", "sh", "ae", "n",  "b", "o", "u", "n"},
                  0.45, 1.12);
}

/// A blink: lids fall fast, stay shut for a frame or two, rise slowly.
Gesture blink(double start) {
  return {start, 0.09, 0.035, 0.19, 0};
}

void mimic(MouthShape& face, double t) {
  const auto add = [&face](const std::string& name, double weight) { face[name] += weight; };
  const auto both = [&add](const std::string& name, double left, double right) {
    add(name + "Left", left);
    add(name + "Right", right);
  };

  const double lids = std::max({blink(0.12).at(t), blink(1.30).at(t), blink(3.02).at(t), blink(4.62).at(t),
                                blink(6.10).at(t), blink(7.30).at(t), blink(9.62).at(t)});
  const double wink = Gesture{8.75, 0.13, 0.22, 0.22, 0}.at(t);
  both("eyeBlink", std::max(lids, wink), lids);
  both("cheekSquint", 0.65 * wink, 0.1 * wink);
  both("mouthSmile", 0.45 * wink, 0.12 * wink);
  both("browDown", 0.35 * wink, 0);

  // While speaking the brows stress "Hello" and "flesh and bone", and the corners of the mouth are friendly.
  const double stress = Gesture{0.5, 0.18, 0.10, 0.35}.at(t) + 0.8 * Gesture{1.95, 0.2, 0.25, 0.45}.at(t);
  add("browInnerUp", 0.22 * stress);
  both("browOuterUp", 0.20 * stress, 0.16 * stress);
  const double friendly = Gesture{0.2, 0.5, 1.9, 0.6}.at(t);
  both("mouthSmile", 0.10 * friendly, 0.08 * friendly);

  // The smile starts a little earlier on the left, reaches the cheeks, then the eyes.
  const Gesture smile{3.12, 0.42, 0.55, 0.55};
  const double left = smile.at(t);
  const double right = smile.at(t - 0.04);
  const double late = smile.at(t - 0.09);
  both("mouthSmile", 0.80 * left, 0.74 * right);
  both("mouthDimple", 0.18 * left, 0.15 * right);
  both("mouthUpperUp", 0.24 * left, 0.22 * right);
  both("mouthLowerDown", 0.12 * left, 0.12 * right);
  both("cheekSquint", 0.50 * late, 0.48 * late);
  both("eyeSquint", 0.34 * late, 0.34 * late);
  add("jawOpen", 0.07 * left);

  // Surprise: brows first, then the eyes, then the jaw drops.
  const Gesture surprise{4.66, 0.22, 0.42, 0.34};
  add("browInnerUp", 0.90 * surprise.at(t));
  both("browOuterUp", 0.85 * surprise.at(t), 0.80 * surprise.at(t - 0.02));
  both("eyeWide", 0.70 * surprise.at(t - 0.03), 0.70 * surprise.at(t - 0.03));
  add("jawOpen", 0.30 * surprise.at(t - 0.08));
  add("mouthFunnel", 0.12 * surprise.at(t - 0.08));

  // Doubt: brows down, nose wrinkled, corners of the mouth down.
  const Gesture doubt{5.48, 0.28, 0.28, 0.36};
  both("browDown", 0.80 * doubt.at(t), 0.72 * doubt.at(t));
  both("eyeSquint", 0.30 * doubt.at(t), 0.30 * doubt.at(t));
  both("noseSneer", 0.50 * doubt.at(t - 0.03), 0.30 * doubt.at(t - 0.03));
  both("mouthFrown", 0.55 * doubt.at(t - 0.05), 0.48 * doubt.at(t - 0.05));
  add("mouthShrugLower", 0.35 * doubt.at(t - 0.05));

  // The jaw swings to the left and to the right, a little open.
  add("jawOpen", 0.20 * Gesture{6.08, 0.28, 0.66, 0.28}.at(t));
  const double swing = Track(0, {{6.50, 0.34, 1.0}, {6.96, 0.42, -1.0}, {7.30, 0.32, 0.0}}).at(t);
  add("jawLeft", 0.75 * std::max(swing, 0.0));
  add("jawRight", 0.75 * std::max(-swing, 0.0));
  add("mouthLeft", 0.15 * std::max(swing, 0.0));
  add("mouthRight", 0.15 * std::max(-swing, 0.0));

  // The kiss: lips gather and press, then part quickly.
  const Gesture kiss{7.36, 0.38, 0.38, 0.20};
  add("mouthPucker", 0.95 * kiss.at(t));
  add("mouthFunnel", 0.12 * kiss.at(t));
  both("mouthPress", 0.20 * kiss.at(t), 0.20 * kiss.at(t));
  both("cheekSquint", 0.16 * kiss.at(t), 0.16 * kiss.at(t));
  both("eyeSquint", 0.35 * kiss.at(t), 0.35 * kiss.at(t));
  const double parting = Gesture{8.14, 0.13, 0.04, 0.30}.at(t);
  add("jawOpen", 0.20 * parting);
  add("mouthFunnel", 0.30 * parting);

  // A small smile stays to the end.
  const double afterglow = Gesture{9.05, 0.4, 0.1, 0.42}.at(t);
  both("mouthSmile", 0.32 * afterglow, 0.26 * afterglow);
  both("cheekSquint", 0.15 * afterglow, 0.12 * afterglow);
}

/// A slow wander that is zero at both ends of the performance, so that it can be played in a loop.
double sway(double t, double phase, double turns) {
  return std::sin(2 * std::numbers::pi * turns * t / length + phase) - std::sin(phase);
}

Vector3d head_angles(double t) {
  const double yaw = Track(0, {{1.00, 0.55, 4},
                               {1.95, 0.60, -3},
                               {2.95, 0.60, 1},
                               {5.05, 0.40, -2},
                               {5.85, 0.45, 5},
                               {7.50, 0.70, 0},
                               {8.75, 0.45, 16},
                               {9.90, 0.70, 0}})
                         .at(t);
  const double pitch = Track(0, {{0.70, 0.25, 3.5},
                                 {0.98, 0.28, -0.5},
                                 {2.12, 0.22, 3.0},
                                 {2.38, 0.26, 0.5},
                                 {2.75, 0.30, 3.5},
                                 {3.20, 0.40, -1},
                                 {4.95, 0.30, -5},
                                 {5.80, 0.40, 3},
                                 {6.35, 0.40, 0},
                                 {7.80, 0.40, -4},
                                 {8.35, 0.30, 2.5},
                                 {9.95, 0.60, 0}})
                           .at(t);
  const double roll = Track(0, {{1.80, 0.80, 2},
                                {3.70, 0.70, -5},
                                {4.80, 0.45, 0},
                                {5.90, 0.45, 3.5},
                                {6.40, 0.40, 0},
                                {8.80, 0.50, -4},
                                {9.90, 0.70, 0}})
                          .at(t);
  return degree * Vector3d(yaw + 0.5 * sway(t, 0.4, 3), pitch + 0.35 * sway(t, 1.9, 4), roll + 0.3 * sway(t, 3.1, 3));
}

/// Where the eyes look, in the head frame: fixations and saccades of 40 to 60 ms. While the head turns, the eyes hold
/// the viewer by counter-rotating, and dart ahead of the larger turns.
Vector3d gaze_angles(double t) {
  const double yaw = Track(0, {{1.25, 0.05, 7},
                               {1.70, 0.05, 0},
                               {4.98, 0.05, -9},
                               {5.50, 0.06, 0},
                               {6.42, 0.06, 12},
                               {6.82, 0.06, -12},
                               {7.28, 0.06, 0},
                               {8.38, 0.06, 14},
                               {8.62, 0.05, 6},
                               {9.42, 0.06, 0}})
                         .at(t);
  const double pitch = Track(0, {{1.25, 0.05, 5},
                                 {1.70, 0.05, 0},
                                 {4.98, 0.05, -11},
                                 {5.50, 0.06, 2},
                                 {6.12, 0.06, 0},
                                 {7.78, 0.06, 4},
                                 {8.38, 0.06, 0}})
                           .at(t);
  const Vector3d hold = -0.85 * head_angles(t);
  return {degree * yaw + hold.x(), degree * pitch + hold.y(), 0};
}

/// The lids and the skin round the eyes follow the gaze.
void look(MouthShape& face, const Vector3d& gaze) {
  const double left = std::max(gaze.x(), 0.0) / full_gaze;
  const double right = std::max(-gaze.x(), 0.0) / full_gaze;
  const double down = std::max(gaze.y(), 0.0) / full_gaze;
  const double up = std::max(-gaze.y(), 0.0) / full_gaze;
  face["eyeLookOutLeft"] = left;
  face["eyeLookInRight"] = left;
  face["eyeLookInLeft"] = right;
  face["eyeLookOutRight"] = right;
  face["eyeLookDownLeft"] = face["eyeLookDownRight"] = down;
  face["eyeLookUpLeft"] = face["eyeLookUpRight"] = up;
}

}  // namespace

Performance first_light(double frame_rate) {
  Performance performance;
  performance.frame_rate = frame_rate;
  for (const auto name : expression_names) performance.expressions.emplace_back(name);
  const auto frames = static_cast<Eigen::Index>(std::lround(length * frame_rate));
  performance.time.resize(frames);
  performance.weights.setZero(frames, static_cast<Eigen::Index>(expression_names.size()));
  performance.head.resize(frames, 3);
  performance.left_eye.resize(frames, 3);
  performance.right_eye.resize(frames, 3);

  const std::vector<Sound> sounds = spoken();
  for (Eigen::Index f = 0; f < frames; ++f) {
    const double t = static_cast<double>(f) / frame_rate;
    MouthShape face = mouth_at(sounds, t);
    mimic(face, t);
    const Vector3d gaze = gaze_angles(t);
    look(face, gaze);
    performance.time(f) = t;
    for (Eigen::Index e = 0; e < performance.weights.cols(); ++e)
      performance.weights(f, e) =
          recorded(std::clamp(face[performance.expressions[static_cast<std::size_t>(e)]], 0.0, 1.0));
    performance.head.row(f) = head_angles(t).unaryExpr(&recorded);
    performance.left_eye.row(f) = gaze.unaryExpr(&recorded);
    performance.right_eye.row(f) = gaze.unaryExpr(&recorded);
  }
  return performance;
}

}  // namespace phiz::authoring
