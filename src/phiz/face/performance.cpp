// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/face/performance.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "phiz/core/error.h"

namespace phiz {

namespace {

/// The angle that is equal to `angle` up to full turns and closest to `reference`.
double near_angle(double angle, double reference) {
  constexpr double turn = 2 * std::numbers::pi;
  return angle - turn * std::round((angle - reference) / turn);
}

std::string frame_name(Eigen::Index frame) {
  return "frame " + std::to_string(frame);
}

void check_angles(const MatrixX3d& angles, Eigen::Index frames, const std::string& name, const std::string& where) {
  if (angles.rows() != frames)
    reject(where, name + " has " + std::to_string(angles.rows()) + " rows for " + std::to_string(frames) + " frames");
  for (Eigen::Index f = 0; f < frames; ++f) {
    if (!angles.row(f).allFinite()) reject(where, name + " of " + frame_name(f) + " is not a number");
    if (angles.row(f).cwiseAbs().maxCoeff() > 2 * std::numbers::pi + 1e-6)
      reject(where, name + " of " + frame_name(f) + " turns by more than a full circle; expected radians",
             "angles in degrees must be multiplied by pi/180");
  }
}

}  // namespace

Matrix3d rotation_from_angles(const Vector3d& yaw_pitch_roll) {
  return (Eigen::AngleAxisd(yaw_pitch_roll[0], Vector3d::UnitY()) *
          Eigen::AngleAxisd(yaw_pitch_roll[1], Vector3d::UnitX()) *
          Eigen::AngleAxisd(yaw_pitch_roll[2], Vector3d::UnitZ()))
      .toRotationMatrix();
}

void validate(const Performance& performance, const std::string& where) {
  const Eigen::Index frames = performance.time.size();
  if (frames == 0) reject(where, "has no frames");
  if (performance.weights.rows() != frames ||
      performance.weights.cols() != static_cast<Eigen::Index>(performance.expressions.size()))
    reject(where, "has " + std::to_string(performance.weights.rows()) + " x " +
                      std::to_string(performance.weights.cols()) + " weights for " + std::to_string(frames) +
                      " frames of " + std::to_string(performance.expressions.size()) + " expressions");
  if (!(performance.frame_rate > 0) || !std::isfinite(performance.frame_rate))
    reject(where, "has a frame rate that is not positive");
  for (Eigen::Index f = 0; f < frames; ++f) {
    if (!std::isfinite(performance.time[f])) reject(where, "time of " + frame_name(f) + " is not a number");
    if (f > 0 && !(performance.time[f] > performance.time[f - 1]))
      reject(where, "time of " + frame_name(f) + " is not later than that of the frame before");
    for (Eigen::Index e = 0; e < performance.weights.cols(); ++e) {
      const double w = performance.weights(f, e);
      const std::string item = performance.expressions[static_cast<std::size_t>(e)] + " of " + frame_name(f);
      if (!std::isfinite(w)) reject(where, "weight " + item + " is not a number");
      if (std::abs(w) > 5)
        reject(where, "weight " + item + " is " + std::to_string(w) + "; expected about 0 to 1",
               "weights in percent must be divided by 100");
    }
  }
  check_angles(performance.head, frames, "head rotation", where);
  check_angles(performance.left_eye, frames, "left eye rotation", where);
  check_angles(performance.right_eye, frames, "right eye rotation", where);
}

Performance resample(const Performance& performance, double frame_rate) {
  if (!(frame_rate > 0) || !std::isfinite(frame_rate)) reject("resampling", "the frame rate must be positive");
  validate(performance, "performance");
  const VectorXd& time = performance.time;
  const Eigen::Index last = time.size() - 1;
  const double duration = time[last] - time[0];
  const auto frames = static_cast<Eigen::Index>(std::floor(duration * frame_rate + 1e-6)) + 1;
  Performance out;
  out.expressions = performance.expressions;
  out.frame_rate = frame_rate;
  out.time.resize(frames);
  out.weights.resize(frames, performance.weights.cols());
  for (MatrixX3d* angles : {&out.head, &out.left_eye, &out.right_eye}) angles->resize(frames, 3);
  Eigen::Index k = 0;
  for (Eigen::Index f = 0; f < frames; ++f) {
    const double t = std::min(time[0] + static_cast<double>(f) / frame_rate, time[last]);
    while (k + 1 < last && time[k + 1] <= t) ++k;
    const Eigen::Index next = std::min(k + 1, last);
    const double s = next > k ? std::clamp((t - time[k]) / (time[next] - time[k]), 0.0, 1.0) : 0.0;
    out.time[f] = static_cast<double>(f) / frame_rate;
    out.weights.row(f) = (1 - s) * performance.weights.row(k) + s * performance.weights.row(next);
    const auto turn = [&](const MatrixX3d& from, MatrixX3d& to) {
      for (int a = 0; a < 3; ++a) to(f, a) = from(k, a) + s * (near_angle(from(next, a), from(k, a)) - from(k, a));
    };
    turn(performance.head, out.head);
    turn(performance.left_eye, out.left_eye);
    turn(performance.right_eye, out.right_eye);
  }
  return out;
}

}  // namespace phiz
