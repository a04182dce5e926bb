// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/face/simulation.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/face/blend.h"
#include "phiz/face/drawn_skin.h"
#include "phiz/face/flesh.h"
#include "phiz/face/head_contacts.h"
#include "phiz/face/take.h"
#include "phiz/geometry/operators.h"

namespace phiz {

namespace {

using Clock = std::chrono::steady_clock;

/// Values as a take keeps them (32-bit), so that a resumed run starts from the same bits.
MatrixX3d as_stored(const MatrixX3d& x) {
  return x.cast<float>().cast<double>();
}

}  // namespace

struct Simulation::Parts {
  const FaceModel* model;
  SimulationOptions options;
  VectorXi soft;
  std::optional<HeadContacts> contacts;
  ProjectiveDynamics solver;
  TargetBlender blender;
  VectorXd share;               ///< of the jaw's motion, per vertex
  std::vector<MatrixX3f> lead;  ///< displacement per shape beyond the jaw's share
  DrawnSkin drawn_skin;

  MatrixX3d x;
  MatrixX3d velocity;
  VectorXd weights;
  Eigen::Isometry3d head = Eigen::Isometry3d::Identity();

  Parts(const FaceModel& face, const SimulationOptions& given)
      : model(&face),
        options(checked(given)),
        soft(phiz::soft_tets(face.head)),
        contacts(given.contact ? std::optional<HeadContacts>(std::in_place, face.head, given.contact_options)
                               : std::nullopt),
        solver(body(), contacts ? contacts->scene.candidates() : VectorXi()),
        blender(face, soft, slots()),
        share(jaw_share(face.head, soft)),
        drawn_skin(face.head),
        x(face.head.volume.V),
        weights(VectorXd::Zero(static_cast<Eigen::Index>(face.shapes.size()))) {
    if (options.dynamic) velocity = MatrixX3d::Zero(x.rows(), 3);
    for (const VolumetricShape& shape : face.shapes) {
      const Eigen::Isometry3d jaw = jaw_transform(face.head.jaw, shape.jaw);
      MatrixX3f d = shape.displacement;
      if (d.rows() != x.rows()) {
        lead.emplace_back();
        continue;
      }
      for (Eigen::Index v = 0; v < x.rows(); ++v) {
        const Vector3d rest = face.head.volume.V.row(v);
        d.row(v) -= (share[v] * (jaw * rest - rest)).cast<float>();
      }
      lead.push_back(std::move(d));
    }
  }

  static SimulationOptions checked(const SimulationOptions& o) {
    if (!(o.stiffness > 0) || !(o.density > 0) || !(o.time_step > 0) || !(o.longest_lead > 0) || !o.gravity.allFinite())
      reject("simulation options", "stiffness, density, time step and longest lead must be positive");
    return o;
  }

  ElasticBody body() const {
    ElasticBody b = flesh_body(model->head, soft, options.weights, options.stiffness);
    b.precision = Precision::single;
    if (options.dynamic) {
      b.time_step = options.time_step;
      b.mass = lumped_tet_mass(b.rest, b.tets, options.density);
    }
    return b;
  }

  std::vector<std::ptrdiff_t> slots() const {
    std::vector<std::ptrdiff_t> out(static_cast<std::size_t>(soft.size()));
    for (std::size_t t = 0; t < out.size(); ++t) out[t] = solver.slot(static_cast<std::ptrdiff_t>(t));
    return out;
  }

  Eigen::Isometry3d jaw_of(const VectorXd& w) const { return jaw_transform(model->head.jaw, blend_jaw(*model, w)); }

  /// Moves x from the weights `from` to `to`: flesh along its share of the jaw and the shapes' own displacements.
  double lead_on(const VectorXd& from, const VectorXd& to) {
    const Eigen::Isometry3d turn = jaw_of(to) * jaw_of(from).inverse();
    std::vector<std::pair<const MatrixX3f*, float>> active;
    for (std::size_t m = 0; m < lead.size(); ++m) {
      const double dw = to[static_cast<Eigen::Index>(m)] - from[static_cast<Eigen::Index>(m)];
      if (std::abs(dw) > 1e-6 && lead[m].rows() > 0) active.emplace_back(&lead[m], static_cast<float>(dw));
    }
    std::vector<double> farthest(static_cast<std::size_t>(x.rows() / 256 + 1), 0.0);
    parallel_chunks(x.rows(), 256, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      MatrixX3f sum = MatrixX3f::Zero(end - begin, 3);
      for (const auto& [d, dw] : active) sum += dw * d->middleRows(begin, end - begin);
      for (std::ptrdiff_t v = begin; v < end; ++v) {
        const Vector3d p = x.row(v);
        const Vector3d move = share[v] * (turn * p - p) + sum.row(v - begin).transpose().cast<double>();
        x.row(v) += move;
        farthest[static_cast<std::size_t>(begin / 256)] =
            std::max(farthest[static_cast<std::size_t>(begin / 256)], move.norm());
      }
    });
    return *std::max_element(farthest.begin(), farthest.end());
  }

  /// Solves for weights `to` from the state at `from`; x holds the lead already.
  SolveStatistics solve_at(const VectorXd& to, const SolveOptions& how) {
    const JawPose pose = blend_jaw(*model, to);
    place_bones(model->head, pose, x);
    if (contacts) contacts->place_jaw(jaw_transform(model->head.jaw, pose));
    blender.blend(to, solver.elements());
    return solver.solve(x, how, contacts ? &contacts->scene : nullptr);
  }

  void check_weights(const VectorXd& to) const {
    if (to.size() != weights.size() || !to.allFinite())
      reject("expression weights", "expected " + std::to_string(weights.size()) + " finite numbers");
  }

  void finish(SolveStatistics& statistics, Clock::time_point start) {
    x = as_stored(x);
    if (options.dynamic) velocity = as_stored(velocity);
    if (contacts) statistics.penetration = contacts->scene.penetration(x);
    statistics.milliseconds = milliseconds_since(start);
  }
};

Simulation::Simulation(const FaceModel& model, const SimulationOptions& options)
    : parts_(std::make_unique<Parts>(model, options)) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

SolveStatistics Simulation::solve_static(const VectorXd& weights) {
  Parts& p = *parts_;
  p.check_weights(weights);
  if (p.options.dynamic) fail("this simulation is dynamic", "use step() or make a static one");
  const auto start = Clock::now();
  const MatrixX3d before = p.x;
  const VectorXd from = p.weights;
  const double reach = p.lead_on(from, weights);
  const int stages = static_cast<int>(std::clamp(std::ceil(reach / p.options.longest_lead), 1.0, 50.0));
  int iterations = 0;
  if (stages > 1) {
    // A jump: go there in parts, so that lips meet where they would meet in motion.
    p.x = before;
    SolveOptions rough = p.options.solve;
    rough.step_tolerance = std::max(rough.step_tolerance, 2e-4);
    rough.max_iterations = std::min(rough.max_iterations, 8);
    VectorXd here = from;
    for (int k = 1; k < stages; ++k) {
      const VectorXd next = from + (weights - from) * (static_cast<double>(k) / stages);
      p.lead_on(here, next);
      iterations += p.solve_at(next, rough).iterations;
      here = next;
    }
    p.lead_on(here, weights);
  }
  SolveStatistics statistics = p.solve_at(weights, p.options.solve);
  statistics.iterations += iterations;
  p.weights = weights;
  if (!p.x.allFinite()) {
    p.x = before;
    statistics.converged = false;
  }
  p.finish(statistics, start);
  return statistics;
}

SolveStatistics Simulation::step(double dt, const VectorXd& weights, const Eigen::Isometry3d& head) {
  Parts& p = *parts_;
  p.check_weights(weights);
  if (!p.options.dynamic) fail("this simulation is static", "use solve_static() or make a dynamic one");
  if (!(dt > 0) || !std::isfinite(dt)) reject("simulation step", "the time step must be positive");
  const auto start = Clock::now();
  const int steps = std::max(1, static_cast<int>(std::lround(dt / p.options.time_step)));
  const double h = p.options.time_step;
  const VectorXd from = p.weights;
  const Eigen::Isometry3d head_from = p.head;
  const Eigen::Quaterniond turn_from(head_from.linear()), turn_to(head.linear());
  SolveStatistics total;
  for (int k = 1; k <= steps; ++k) {
    const double s = static_cast<double>(k) / steps;
    const VectorXd now = from + s * (weights - from);
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = turn_from.slerp(s, turn_to).toRotationMatrix();
    pose.translation() = (1 - s) * head_from.translation() + s * head.translation();
    // Inertia is straight in the world; the solve is in the head frame, where the targets turn along.
    const MatrixX3d world = (p.x * p.head.linear().transpose()).rowwise() + p.head.translation().transpose();
    const MatrixX3d y_world = (world + h * p.velocity).rowwise() + h * h * p.options.gravity.transpose();
    const Eigen::Isometry3d to_head = pose.inverse();
    p.solver.set_prediction((y_world * to_head.linear().transpose()).rowwise() + to_head.translation().transpose());
    const MatrixX3d before = p.x;
    p.lead_on(p.weights, now);
    SolveStatistics statistics = p.solve_at(now, p.options.solve);
    if (!p.x.allFinite()) {
      p.x = before;
      statistics.converged = false;
    }
    p.velocity = (((p.x * pose.linear().transpose()).rowwise() + pose.translation().transpose()) - world) / h;
    p.head = pose;
    p.weights = now;
    const int iterations = total.iterations + statistics.iterations;
    const bool converged = (k == 1 || total.converged) && statistics.converged;
    total = statistics;
    total.iterations = iterations;
    total.converged = converged;
  }
  p.head = head;
  p.weights = weights;
  p.finish(total, start);
  return total;
}

const MatrixX3d& Simulation::positions() const {
  return parts_->x;
}

MatrixX3d Simulation::skin() const {
  return parts_->drawn_skin.at(parts_->x);
}

JawPose Simulation::jaw() const {
  return blend_jaw(*parts_->model, parts_->weights);
}

void Simulation::set_forces(const MatrixX3d& forces) {
  parts_->solver.set_forces(forces);
}

void Simulation::forget() {
  parts_->solver.forget();
  if (parts_->contacts) parts_->contacts->scene.forget();
}

SimulationState Simulation::state() const {
  return {parts_->x, parts_->velocity, parts_->weights, parts_->head};
}

void Simulation::restore(const SimulationState& state) {
  Parts& p = *parts_;
  p.check_weights(state.weights);
  if (state.positions.rows() != p.x.rows() || !state.positions.allFinite())
    reject("simulation state", "does not belong to this model: " + std::to_string(state.positions.rows()) +
                                   " positions instead of " + std::to_string(p.x.rows()));
  if (p.options.dynamic && (state.velocity.rows() != p.x.rows() || !state.velocity.allFinite()))
    reject("simulation state", "has no velocities", "it comes from a static run; start anew");
  forget();
  p.x = as_stored(state.positions);
  if (p.options.dynamic) p.velocity = as_stored(state.velocity);
  p.weights = state.weights;
  p.head = state.head;
}

const VectorXi& Simulation::soft_tets() const {
  return parts_->soft;
}
const SimulationOptions& Simulation::options() const {
  return parts_->options;
}

double Simulation::penetration() const {
  return parts_->contacts ? parts_->contacts->scene.penetration(parts_->x) : 0.0;
}

int Simulation::contacts_left_out() const {
  return parts_->contacts ? parts_->contacts->scene.left_out() : 0;
}

}  // namespace phiz
