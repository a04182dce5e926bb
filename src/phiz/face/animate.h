// SPDX-License-Identifier: GPL-3.0-or-later
/// Animate a face model by a performance.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "phiz/face/performance.h"
#include "phiz/face/simulation.h"
#include "phiz/face/take.h"

namespace phiz {

struct AnimateOptions {
  SimulationOptions simulation;
  int first_frame = 0;                              ///< of the performance
  int end_frame = -1;                               ///< one past the last one; -1: all
  Vector3d head_pivot = Vector3d(0, -0.03, -0.02);  ///< the head turns about this point, metres
  bool keep_volume = false;                         ///< keep the volume of the frames of a whole take, for resuming
};

/// How the columns of a performance meet the shapes of a model.
struct ExpressionMatch {
  std::vector<int> column;             ///< per shape: column of Performance::weights, or -1
  std::vector<std::string> unmatched;  ///< expressions of the performance that the model does not have
  std::vector<std::string> undriven;   ///< shapes of the model that the performance does not name
  /// An eye: the shape that is its blink, and lid_closing() of all shapes.
  struct Eye {
    Eigen::Index blink = -1;
    VectorXd closing;
  };
  std::vector<Eye> eyes;
};
ExpressionMatch match_expressions(const FaceModel& model, const Performance& performance);

/// Weights per shape in a frame: those of the performance, but that mouthClose, which closes what jawOpen opens, is
/// held to the weight of jawOpen and 0.15 more, and a blink to what other expressions leave open of the eye; beyond,
/// lips and lids would have to pass through each other.
VectorXd shape_weights(const ExpressionMatch& match, const Performance& performance, Eigen::Index frame);

/// Pose of the head in a frame, world from head: its rotation about `pivot`, metres.
Eigen::Isometry3d head_pose(const Performance& performance, Eigen::Index frame, const Vector3d& pivot);

/// Rotations of the eyes in a frame: those of the performance, or from its eyeLook weights if it records no rotation at
/// all.
std::pair<Matrix3d, Matrix3d> eye_rotations(const Performance& performance, Eigen::Index frame);

/// A take with everything but the frames.
Take empty_take(const FaceModel& model, const Performance& performance, const AnimateOptions& options = {});

/// Called with each finished frame and its number in the performance; returns false to stop.
using FrameCallback = std::function<bool(const TakeFrame& frame, int number)>;

/// Frames from one key frame to the next. A key frame depends on nothing but the frame before it, so that a run can be
/// continued there.
constexpr int key_interval = 24;

/// The last key frame among the first `finished` frames of a take, or the one that would follow.
constexpr int last_key_frame(int finished) {
  return finished / key_interval * key_interval;
}

/// Plays the frames of a performance and calls `on_frame` for each. The result does not depend on where a run was
/// interrupted: to continue one, give its `finished` frames, of which the one before last_key_frame() must hold
/// `volume` (and `velocity` in dynamics); the others may be empty. It is played again from there, without calls. A
/// frame that did not converge is the best state reached and says so. Stops early, without error, when interrupted() or
/// when the callback says so.
void animate(const FaceModel& model, const Performance& performance, const AnimateOptions& options,
             const std::vector<TakeFrame>& finished, const FrameCallback& on_frame);

/// The whole take at once.
Take animate(const FaceModel& model, const Performance& performance, const AnimateOptions& options = {},
             const FrameCallback& on_frame = {});

}  // namespace phiz
