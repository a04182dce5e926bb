// SPDX-License-Identifier: GPL-3.0-or-later
/// What a frame of a performance asks of a model: weights of its shapes, pose of the head, rotation of the eyes. Shared
/// by all that plays performances (animate.h, simulate.h).
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "phiz/face/face_model.h"
#include "phiz/face/performance.h"
#include "phiz/face/take.h"

namespace phiz {

struct PlayOptions {
  int first_frame = 0;                              ///< of the performance
  int end_frame = -1;                               ///< one past the last one; -1: all
  Vector3d head_pivot = Vector3d(0, -0.03, -0.02);  ///< the head turns about this point, metres
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

/// Rotations of the eyes in a frame: those of the performance, or from its eyeLook weights if it records no rotation at
/// all.
std::pair<Matrix3d, Matrix3d> eye_rotations(const Performance& performance, Eigen::Index frame);

/// Pose of the head in a frame, world from head: it turns about `pivot`.
Eigen::Isometry3d head_pose(const Performance& performance, Eigen::Index frame, const Vector3d& pivot);

/// One past the last frame to play. Throws phiz::Error(usage) for frames that the performance does not have.
int end_frame(const Performance& performance, const PlayOptions& options);

/// A take with everything but the frames.
Take empty_take(const FaceModel& model, const Performance& performance, const PlayOptions& options = {});

/// A frame of a take as the performance has it, before anything is solved: time, weights, head and eyes.
TakeFrame played_frame(const ExpressionMatch& match, const Performance& performance, Eigen::Index frame,
                       const PlayOptions& options);

/// Called with each finished frame and its number in the performance; returns false to stop.
using FrameCallback = std::function<bool(const TakeFrame& frame, int number)>;

}  // namespace phiz
