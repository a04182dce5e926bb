// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/face/simulate.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "phiz/core/error.h"
#include "phiz/core/progress.h"
#include "phiz/geometry/spatial_query.h"
#include "phiz/geometry/validate.h"

namespace phiz {

namespace {

void check(const SimulateOptions& options) {
  if (!(options.gusts.share >= 0) || !(options.gusts.period > 0) || !std::isfinite(options.gusts.share))
    reject("gusts of wind", "need a share of at least 0 and a period above 0 seconds");
  if (options.head_path) validate(*options.head_path, "path of the head");
  for (const SimulateObject& object : options.objects) {
    validate(object.mesh, "object");
    require_closed_manifold(object.mesh, "object");
    validate(object.path, "path of the object");
  }
}

class Player {
 public:
  Player(const FaceModel& model, const TakeFrame& first, double frame_rate, const SimulateOptions& options)
      : options_(options), simulation_(made(model, options)) {
    if (!options.paralysed.empty())
      simulation_.set_tet_innervation(paralysis(model.head, simulation_.tissue(), options.paralysed));
    begin(model.head, first, frame_rate);
  }

  /// `dt`: seconds since the frame before.
  void play(TakeFrame& frame, double dt) {
    set_environment(frame.time, frame.head);
    const bool dynamic = options_.muscles.dynamic;
    frame.statistics = dynamic ? simulation_.step(dt, frame.part_weights, frame.head)
                               : simulation_.settle(frame.part_weights, frame.head);
    frame.statistics.penetration = std::max(frame.statistics.penetration, simulation_.penetration());
    frame.jaw = simulation_.jaw();
    frame.skin = simulation_.skin().cast<float>();
    frame.volume = simulation_.positions().cast<float>();
    if (dynamic) frame.velocity = simulation_.velocity().cast<float>();
  }

 private:
  static MuscleSimulation made(const FaceModel& model, const SimulateOptions& options) {
    const HeadTissue tissue = head_tissue(model.head, options.muscles.tissue);
    return {model, estimate_activations(model, tissue), options.muscles};
  }

  void set_environment(double time, const Eigen::Isometry3d& head) {
    if (options_.gusts.share > 0)
      simulation_.set_wind((1 + options_.gusts.share * std::sin(2 * std::numbers::pi * time / options_.gusts.period)) *
                           options_.muscles.air.wind);
    for (std::size_t i = 0; i < options_.objects.size(); ++i)
      simulation_.move_object(static_cast<int>(i), place_of(options_.objects[i], time, head));
  }

  static Eigen::Isometry3d place_of(const SimulateObject& object, double time, const Eigen::Isometry3d& head) {
    return object.on_head ? head * object.path.at(time) : object.path.at(time);
  }

  /// `first`: what the first frame asks for.
  void begin(const HeadTemplate& head, const TakeFrame& first, double frame_rate) {
    Trace* const trace = std::exchange(simulation_.solve_options().trace, nullptr);
    simulation_.settle(first.part_weights, first.head);
    double earliest = first.time;
    for (const SimulateObject& object : options_.objects) {
      if (object.path.time.size() > 1) earliest = std::min(earliest, object.path.time.front());
      const Eigen::Isometry3d place = place_of(object, std::min(first.time, object.path.time.front()), first.head);
      refuse_overlap(head, object.mesh, first.head.inverse() * place);
      simulation_.add_object(object.mesh, place);
    }
    if (earliest < first.time) {
      constexpr double most_steps = 600;
      const int steps = static_cast<int>(std::clamp(std::ceil((first.time - earliest) * frame_rate), 1.0, most_steps));
      for (int k = 1; k <= steps && !interrupted(); ++k) {
        set_environment(earliest + (first.time - earliest) * k / steps, first.head);
        simulation_.settle(first.part_weights, first.head);
      }
    }
    simulation_.solve_options().trace = trace;
  }

  void refuse_overlap(const HeadTemplate& head, const TriangleMesh& mesh, const Eigen::Isometry3d& place) const {
    const SurfaceQuery query(mesh);
    const Eigen::Isometry3d back = place.inverse();
    int inside = 0;
    for (const int v : head.skin_vertices) inside += query.is_inside(back * simulation_.positions().row(v).transpose());
    if (inside > 0)
      reject("object",
             "it reaches into the head where it starts: " + std::to_string(inside) + " vertices of the skin are inside",
             "let it come from outside, on a path that begins before the first frame");
  }

  const SimulateOptions& options_;
  MuscleSimulation simulation_;
};

}  // namespace

Performance held_expression(const std::map<std::string, double>& weights, double seconds, double frame_rate,
                            double ramp) {
  constexpr double longest = 3600;
  if (!(seconds >= 0 && seconds <= longest) || !(frame_rate > 0 && frame_rate <= 1000) || !(ramp >= 0))
    reject("held expression", "times must be from 0 to 3600 seconds and the frame rate positive, at most 1000");
  const auto frames = std::max<Eigen::Index>(1, std::lround(seconds * frame_rate));
  Performance out;
  out.frame_rate = frame_rate;
  out.time.resize(frames);
  out.weights.resize(frames, static_cast<Eigen::Index>(weights.size()));
  out.head = out.left_eye = out.right_eye = MatrixX3d::Zero(frames, 3);
  for (const auto& [name, weight] : weights) out.expressions.push_back(name);
  for (Eigen::Index f = 0; f < frames; ++f) {
    out.time[f] = static_cast<double>(f) / frame_rate;
    const double share = ramp > 0 ? std::min(1.0, out.time[f] / ramp) : 1;
    Eigen::Index e = 0;
    for (const auto& [name, weight] : weights) out.weights(f, e++) = share * weight;
  }
  return out;
}

void simulate(const FaceModel& model, const Performance& performance, const SimulateOptions& options,
              const FrameCallback& on_frame) {
  validate(performance, "performance");
  check(options);
  const int end = end_frame(performance, options);
  const ExpressionMatch match = match_expressions(model, performance);
  const auto asked = [&](int number) {
    TakeFrame frame = played_frame(match, performance, number, options);
    if (options.head_path) frame.head = options.head_path->at(frame.time) * frame.head;
    return frame;
  };
  Player player(model, asked(options.first_frame), performance.frame_rate, options);
  for (int next = options.first_frame; next < end && !interrupted(); ++next) {
    TakeFrame frame = asked(next);
    const double dt =
        next > options.first_frame ? performance.time[next] - performance.time[next - 1] : 1.0 / performance.frame_rate;
    player.play(frame, dt);
    if (!on_frame(frame, next)) break;
  }
}

Take simulate(const FaceModel& model, const Performance& performance, const SimulateOptions& options) {
  Take take = empty_take(model, performance, options);
  simulate(model, performance, options, [&](const TakeFrame& frame, int) {
    take.frames.push_back(frame);
    return true;
  });
  return take;
}

}  // namespace phiz
