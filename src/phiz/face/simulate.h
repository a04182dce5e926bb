// SPDX-License-Identifier: GPL-3.0-or-later
/// Forward physics of a performance: muscles, contact, inertia, gravity, wind and rigid objects (Ichim et al. 2017,
/// section 4; phace.md sections 7 and 8), frame by frame.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "phiz/face/muscle_simulation.h"
#include "phiz/face/play.h"
#include "phiz/face/rigid_path.h"

namespace phiz {

/// A rigid thing that the skin must stay outside of.
struct SimulateObject {
  TriangleMesh mesh;     ///< closed, outward, metres
  RigidPath path;        ///< in the time of the performance. What lies before the first frame is an approach at rest
  bool on_head = false;  ///< the path is in the head frame, not in the world: a headset, a hand on the cheek
};

/// Wind blows with 1 + share sin(2 pi t / period) times its speed.
struct Gusts {
  double share = 0;
  double period = 1;  ///< seconds
};

struct SimulateOptions : PlayOptions {
  MuscleOptions muscles;
  Gusts gusts;
  std::vector<SimulateObject> objects;
  std::vector<std::string> paralysed;  ///< as paralysis() takes them
  std::optional<RigidPath> head_path;  ///< moves the head, on top of the rotation that the performance gives
};

/// A performance that shows one expression: from neutral to `weights` in the first `ramp` seconds, then held; as many
/// frames as fit into `seconds`, at least one. Throws phiz::Error(bad_input) for negative or endless times and rates.
Performance held_expression(const std::map<std::string, double>& weights, double seconds, double frame_rate,
                            double ramp = 0);

/// Plays the frames of a performance and calls `on_frame` for each. Muscles strive for what estimate_activations()
/// says. Statics: every frame is in balance with the head at its pose. Dynamics: starts at rest in the balance of the
/// first frame; options.muscles.dynamic decides. The frames hold `volume` and, in dynamics, `velocity`; their
/// penetration is that of an independent search. Frames that did not converge say so and are the best state reached.
/// Stops early, without error, when interrupted() or when the callback says so. Throws phiz::Error for models and
/// options that cannot be simulated; an object that reaches into the skin at its first place is refused.
void simulate(const FaceModel& model, const Performance& performance, const SimulateOptions& options,
              const FrameCallback& on_frame);

/// The whole take at once.
Take simulate(const FaceModel& model, const Performance& performance, const SimulateOptions& options = {});

}  // namespace phiz
