// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/face/play.h"

#include <algorithm>
#include <cctype>
#include <tuple>
#include <utility>

#include "phiz/core/error.h"
#include "phiz/face/lid_closing.h"

namespace phiz {

namespace {

bool same_name(const std::string& a, const std::string& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](unsigned char x, unsigned char y) {
           return std::tolower(x) == std::tolower(y);
         });
}

int column_of(const Performance& performance, const std::string& name) {
  for (std::size_t e = 0; e < performance.expressions.size(); ++e)
    if (same_name(performance.expressions[e], name)) return static_cast<int>(e);
  return -1;
}

double weight_of(const Performance& performance, Eigen::Index frame, const std::string& name) {
  const int column = column_of(performance, name);
  return column >= 0 ? performance.weights(frame, column) : 0.0;
}

}  // namespace

ExpressionMatch match_expressions(const FaceModel& model, const Performance& performance) {
  ExpressionMatch match;
  std::vector<char> used(performance.expressions.size(), 0);
  for (const VolumetricShape& shape : model.shapes) {
    const int column = column_of(performance, shape.name);
    match.column.push_back(column);
    if (column >= 0)
      used[static_cast<std::size_t>(column)] = 1;
    else
      match.undriven.push_back(shape.name);
  }
  for (std::size_t e = 0; e < used.size(); ++e)
    if (!used[e]) match.unmatched.push_back(performance.expressions[e]);
  for (const std::string side : {"left", "right"}) {
    const VectorXd closing = lid_closing(model.head, side);
    ExpressionMatch::Eye eye;
    eye.closing = VectorXd::Zero(static_cast<Eigen::Index>(model.shapes.size()));
    for (std::size_t m = 0; m < model.shapes.size() && closing.size() > 0; ++m)
      for (std::size_t e = 0; e < model.head.expressions.size(); ++e) {
        if (model.head.expressions[e].name != model.shapes[m].name) continue;
        eye.closing[static_cast<Eigen::Index>(m)] = closing[static_cast<Eigen::Index>(e)];
        if (model.shapes[m].name == (side == "left" ? "eyeBlinkLeft" : "eyeBlinkRight"))
          eye.blink = static_cast<Eigen::Index>(m);
      }
    if (eye.blink >= 0) match.eyes.push_back(std::move(eye));
  }
  return match;
}

VectorXd shape_weights(const ExpressionMatch& match, const Performance& performance, Eigen::Index frame) {
  constexpr double pressing = 0.15, closed = 1.1;  // of lips that meet already; blinks that press lids together
  const int close = column_of(performance, "mouthClose");
  const double most = weight_of(performance, frame, "jawOpen") + pressing;
  VectorXd weights(static_cast<Eigen::Index>(match.column.size()));
  for (Eigen::Index m = 0; m < weights.size(); ++m) {
    const int column = match.column[static_cast<std::size_t>(m)];
    weights[m] = column >= 0 ? performance.weights(frame, column) : 0.0;
    if (column >= 0 && column == close) weights[m] = std::min(weights[m], most);
  }
  for (const auto& [blink, closing] : match.eyes) {
    const double too_far = weights.dot(closing) - std::max(closed, weights[blink]);
    if (too_far > 0) weights[blink] = std::max(0.0, weights[blink] - too_far);
  }
  return weights;
}

std::pair<Matrix3d, Matrix3d> eye_rotations(const Performance& performance, Eigen::Index frame) {
  if (!performance.left_eye.isZero(0) || !performance.right_eye.isZero(0))
    return {rotation_from_angles(performance.left_eye.row(frame)),
            rotation_from_angles(performance.right_eye.row(frame))};
  // A full eyeLook weight is taken for the usual range of the eye: 35 degrees aside, 30 up, 35 down.
  constexpr double degree = 3.14159265358979323846 / 180;
  const auto eye = [&](const char* toward_left, const char* toward_right, const char* down, const char* up) {
    const double yaw =
        35 * degree * (weight_of(performance, frame, toward_left) - weight_of(performance, frame, toward_right));
    const double pitch = degree * (35 * weight_of(performance, frame, down) - 30 * weight_of(performance, frame, up));
    return rotation_from_angles({yaw, pitch, 0});
  };
  return {eye("eyeLookOutLeft", "eyeLookInLeft", "eyeLookDownLeft", "eyeLookUpLeft"),
          eye("eyeLookInRight", "eyeLookOutRight", "eyeLookDownRight", "eyeLookUpRight")};
}

Eigen::Isometry3d head_pose(const Performance& performance, Eigen::Index frame, const Vector3d& pivot) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = rotation_from_angles(performance.head.row(frame));
  pose.translation() = pivot - pose.linear() * pivot;
  return pose;
}

int end_frame(const Performance& performance, const PlayOptions& options) {
  const int frames = static_cast<int>(performance.time.size());
  const int end = options.end_frame < 0 ? frames : options.end_frame;
  if (options.first_frame < 0 || options.first_frame >= end || end > frames)
    throw Error(ErrorKind::usage, "frames " + std::to_string(options.first_frame) + " to " + std::to_string(end) +
                                      " are not in the performance, which has " + std::to_string(frames));
  return end;
}

Take empty_take(const FaceModel& model, const Performance& performance, const PlayOptions& options) {
  Take take;
  take.model = model.head.name;
  take.frame_rate = performance.frame_rate;
  take.skin = model.head.skin;
  take.parts = model.head.parts;
  take.joint = model.head.jaw;
  take.left_eye_centre = model.head.left_eye_centre;
  take.right_eye_centre = model.head.right_eye_centre;
  for (const VolumetricShape& shape : model.shapes) take.expressions.push_back(shape.name);
  take.frames_planned = end_frame(performance, options) - options.first_frame;
  return take;
}

TakeFrame played_frame(const ExpressionMatch& match, const Performance& performance, Eigen::Index frame,
                       const PlayOptions& options) {
  TakeFrame out;
  out.time = performance.time[frame];
  out.part_weights = shape_weights(match, performance, frame);
  out.head = head_pose(performance, frame, options.head_pivot);
  std::tie(out.left_eye, out.right_eye) = eye_rotations(performance, frame);
  return out;
}

}  // namespace phiz
