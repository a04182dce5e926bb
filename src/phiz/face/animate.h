// SPDX-License-Identifier: GPL-3.0-or-later
/// Animate a face model by a performance.
#pragma once

#include <vector>

#include "phiz/face/play.h"
#include "phiz/face/simulation.h"

namespace phiz {

struct AnimateOptions : PlayOptions {
  SimulationOptions simulation;
  bool keep_volume = false;  ///< keep the volume of the frames of a whole take, for resuming
};

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
