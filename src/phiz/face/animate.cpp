// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/face/animate.h"

#include "phiz/core/error.h"
#include "phiz/core/progress.h"

namespace phiz {

void animate(const FaceModel& model, const Performance& performance, const AnimateOptions& options,
             const std::vector<TakeFrame>& finished, const FrameCallback& on_frame) {
  validate(performance, "performance");
  const int end = end_frame(performance, options);
  const int done = static_cast<int>(finished.size());
  if (done > end - options.first_frame) reject("take", "has more frames than were asked for");
  if (done == end - options.first_frame) return;
  const ExpressionMatch match = match_expressions(model, performance);
  Simulation simulation(model, options.simulation);
  const bool dynamic = options.simulation.dynamic;
  int next = options.first_frame + last_key_frame(done);
  if (next > options.first_frame) {
    const TakeFrame& before = finished[static_cast<std::size_t>(next - options.first_frame - 1)];
    if (before.volume.rows() == 0)
      reject("take", "the frame before its last key frame does not hold the volume that is needed to resume",
             "start anew");
    simulation.restore({before.volume.cast<double>(), before.velocity.cast<double>(),
                        shape_weights(match, performance, next - 1),
                        head_pose(performance, next - 1, options.head_pivot)});
  } else if (dynamic) {
    // Start at rest in the pose of the first frame, held by a static solve.
    SimulationOptions still = options.simulation;
    still.dynamic = false;
    Simulation start(model, still);
    const VectorXd weights = shape_weights(match, performance, next);
    start.solve_static(weights);
    SimulationState state = start.state();
    state.velocity = MatrixX3d::Zero(state.positions.rows(), 3);
    state.head = head_pose(performance, next, options.head_pivot);
    simulation.restore(state);
  }
  for (; next < end && !interrupted(); ++next) {
    const int number = next - options.first_frame;
    if (number % key_interval == 0) simulation.forget();
    TakeFrame frame = played_frame(match, performance, next, options);
    if (dynamic) {
      const double dt = next > options.first_frame ? performance.time[next] - performance.time[next - 1]
                                                   : 1.0 / performance.frame_rate;
      frame.statistics = simulation.step(dt, frame.part_weights, frame.head);
      frame.velocity = simulation.state().velocity.cast<float>();
    } else {
      frame.statistics = simulation.solve_static(frame.part_weights);
    }
    if (number < done) continue;
    frame.jaw = simulation.jaw();
    frame.skin = simulation.skin().cast<float>();
    frame.volume = simulation.positions().cast<float>();
    if (!on_frame(frame, next)) break;
  }
}

Take animate(const FaceModel& model, const Performance& performance, const AnimateOptions& options,
             const FrameCallback& on_frame) {
  Take take = empty_take(model, performance, options);
  animate(model, performance, options, {}, [&](const TakeFrame& frame, int number) {
    take.frames.push_back(frame);
    if (!options.keep_volume) {
      take.frames.back().volume.resize(0, 3);
      take.frames.back().velocity.resize(0, 3);
    }
    return !on_frame || on_frame(frame, number);
  });
  return take;
}

}  // namespace phiz
