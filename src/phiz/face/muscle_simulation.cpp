// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/face/muscle_simulation.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "phiz/core/error.h"
#include "phiz/face/drawn_skin.h"
#include "phiz/face/head_contacts.h"
#include "phiz/face/rigid_path.h"
#include "phiz/geometry/operators.h"

namespace phiz {

namespace {

const MuscleOptions& checked(const MuscleOptions& o) {
  if (!(o.time_step > 0) || !(o.damping >= 0) || !(o.object_step > 0) || !o.gravity.allFinite() ||
      !o.tissue.gravity.isZero(0))
    reject("muscle simulation options",
           "time and object steps must be positive, damping at least 0, and gravity is given once, for the world");
  return o;
}

MatrixX3d moved(const Eigen::Isometry3d& by, const MatrixX3d& x) {
  return (x * by.linear().transpose()).rowwise() + by.translation().transpose();
}

struct Object {
  int obstacle = -1;
  double radius = 0;  ///< of its vertices about its origin
  Eigen::Isometry3d place = Eigen::Isometry3d::Identity(), next = Eigen::Isometry3d::Identity();  ///< world
  Eigen::Isometry3d seen = Eigen::Isometry3d::Identity();  ///< head from object at the last solve
};

/// At least as far as any vertex of the object goes.
double way(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, double radius) {
  const Eigen::AngleAxisd turn(Eigen::Quaterniond(to.linear() * from.linear().transpose()));
  return (to.translation() - from.translation()).norm() + std::abs(turn.angle()) * radius;
}

}  // namespace

struct MuscleSimulation::Parts {
  MuscleOptions options;
  HeadTemplate head;  ///< what contact, jaw and skin need of it
  HeadTissue tissue;
  ActivationBlender blender;
  std::vector<ActivationShape> shapes;
  std::optional<HeadContacts> contacts;
  DrawnSkin drawn_skin;
  VectorXd mass;
  TissueSolver solver;
  std::vector<Object> objects;
  std::optional<VectorXd> innervated;
  MatrixX3d forces;

  Stretches stretches;  ///< of blender.tets()
  JawPose jaw = JawPose::Zero();
  VectorXd weights;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  MatrixX3d velocity;

  Parts(const FaceModel& model, const std::vector<ActivationShape>& given, const MuscleOptions& how)
      : options(checked(how)),
        head(model.head),
        tissue(head_tissue(head, options.tissue)),
        blender(given, tissue),
        shapes(given),
        contacts(options.contact ? std::optional<HeadContacts>(std::in_place, head, options.contact_options)
                                 : std::nullopt),
        drawn_skin(head),
        mass(lumped_tet_mass(tissue.body.rest, tissue.body.tets, options.tissue.density)),
        solver(tissue.body, options.solve),
        weights(VectorXd::Zero(static_cast<Eigen::Index>(given.size()))),
        velocity(MatrixX3d::Zero(head.volume.V.rows(), 3)) {
    solver.watch(head.skin_vertices);
  }

  void require_static() const {
    if (options.dynamic) fail("this simulation is dynamic", "use step() or make a static one");
  }

  ContactScene* scene() { return contacts ? &contacts->scene : nullptr; }

  void set_weights(const VectorXd& w) {
    if (w.size() != weights.size() || !w.allFinite())
      reject("expression weights", "expected " + std::to_string(weights.size()) + " finite numbers");
    blender.blend(w, stretches);
    if (innervated) scale_activation((*innervated)(blender.tets()), stretches);
    solver.set_activation(blender.tets(), stretches);
    jaw = blend_jaw(head.jaw, shapes, w);
    weights = w;
  }

  /// Forces that the solve does not know of: gravity, wind and what was given.
  void apply_loads() {
    const Matrix3d to_head = pose.linear().transpose();
    MatrixX3d all = mass * (to_head * options.gravity).transpose();
    if (forces.rows() > 0) all += forces;
    if (!options.air.wind.isZero(0)) {
      Air air = options.air;
      air.wind = to_head * air.wind;
      all += wind_forces(head.skin_triangles, solver.positions(), velocity * to_head.transpose(), air);
    }
    solver.set_forces(all);
  }

  /// Solves for the present activations, jaw and pose, with objects on their way.
  SolveStatistics solve() {
    solver.set_slides(place_slides(head, tissue.body, jaw));
    MatrixX3d pins = solver.positions();
    place_pins(head, tissue, jaw, pins);
    if (contacts) contacts->place_jaw(jaw_transform(head.jaw, jaw));
    // As the head sees them: they move, or it does.
    double longest = 0;
    for (const Object& object : objects)
      longest = std::max(longest, way(object.seen, pose.inverse() * object.next, object.radius));
    const int parts = std::max(1, static_cast<int>(std::ceil(longest / options.object_step)));
    SolveStatistics statistics;
    int iterations = 0;
    for (int part = 1; part <= parts; ++part) {
      for (const Object& object : objects)
        contacts->scene.place(object.obstacle,
                              between(object.seen, pose.inverse() * object.next, static_cast<double>(part) / parts));
      statistics = solver.solve(pins, scene());
      iterations += statistics.iterations;
    }
    for (Object& object : objects) {
      object.place = object.next;
      object.seen = pose.inverse() * object.next;
    }
    if (!statistics.converged && !options.dynamic && objects.empty()) {
      statistics = solve_from_rest(pins, statistics);
      iterations += statistics.iterations;
    }
    statistics.iterations = iterations;
    return statistics;
  }

  /// Another try, which does not depend on where the face was before. The state of the `first` one stays unless this
  /// converges.
  SolveStatistics solve_from_rest(const MatrixX3d& pins, const SolveStatistics& first) {
    const MatrixX3d before = solver.positions();
    solver.restart(tissue.body.rest);
    if (contacts) contacts->scene.forget();
    const SolveStatistics second = solver.solve(pins, scene());
    if (second.converged) return second;
    solver.restart(before);
    if (contacts) contacts->scene.forget();
    SolveStatistics out = first;
    out.iterations = second.iterations;
    return out;
  }
};

MuscleSimulation::MuscleSimulation(const FaceModel& model, const std::vector<ActivationShape>& shapes,
                                   const MuscleOptions& options)
    : parts_(std::make_unique<Parts>(model, shapes, options)) {}
MuscleSimulation::~MuscleSimulation() = default;
MuscleSimulation::MuscleSimulation(MuscleSimulation&&) noexcept = default;
MuscleSimulation& MuscleSimulation::operator=(MuscleSimulation&&) noexcept = default;

SolveStatistics MuscleSimulation::solve_static(const VectorXd& weights) {
  const auto start = std::chrono::steady_clock::now();
  parts_->require_static();
  parts_->set_weights(weights);
  parts_->apply_loads();
  SolveStatistics statistics = parts_->solve();
  statistics.milliseconds = milliseconds_since(start);
  return statistics;
}

SolveStatistics MuscleSimulation::settle(const VectorXd& weights, const Eigen::Isometry3d& head) {
  Parts& p = *parts_;
  const auto start = std::chrono::steady_clock::now();
  p.set_weights(weights);
  rest(head);
  p.solver.set_inertia(0, {});
  p.apply_loads();
  SolveStatistics statistics = p.solve();
  statistics.milliseconds = milliseconds_since(start);
  return statistics;
}

SolveStatistics MuscleSimulation::solve_static(const std::vector<Matrix3d>& stretches, const JawPose& jaw) {
  Parts& p = *parts_;
  p.require_static();
  if (!jaw.allFinite()) reject("pose of the jaw", "is not finite");
  const auto start = std::chrono::steady_clock::now();
  p.solver.set_activation(stretches);
  p.jaw = jaw;
  p.apply_loads();
  SolveStatistics statistics = p.solve();
  statistics.milliseconds = milliseconds_since(start);
  return statistics;
}

SolveStatistics MuscleSimulation::step(double dt, const VectorXd& weights, const Eigen::Isometry3d& head) {
  Parts& p = *parts_;
  if (!p.options.dynamic) fail("this simulation is static", "use solve_static() or make a dynamic one");
  if (!(dt > 0) || !std::isfinite(dt)) reject("simulation step", "the time step must be positive");
  const auto start = std::chrono::steady_clock::now();
  const double h = p.options.time_step;
  const int steps = std::max(1, static_cast<int>(std::lround(dt / h)));
  const VectorXd from = p.weights;
  const Eigen::Isometry3d head_from = p.pose;
  std::vector<Eigen::Isometry3d> first, last;
  for (const Object& object : p.objects) {
    first.push_back(object.place);
    last.push_back(object.next);
  }
  SolveStatistics total;
  for (int k = 1; k <= steps; ++k) {
    const double share = static_cast<double>(k) / steps;
    p.set_weights(from + share * (weights - from));
    for (std::size_t i = 0; i < first.size(); ++i) p.objects[i].next = between(first[i], last[i], share);
    const MatrixX3d world = moved(p.pose, p.solver.positions());
    const Eigen::Isometry3d next_pose = between(head_from, head, share);
    // What moves with the head is not damped.
    const MatrixX3d carried = (moved(next_pose, p.solver.positions()) - world) / h;
    const MatrixX3d ahead = world + h * (carried + (p.velocity - carried) / (1 + p.options.damping * h));
    p.pose = next_pose;
    p.apply_loads();
    p.solver.set_inertia(h, moved(p.pose.inverse(), ahead));
    const SolveStatistics statistics = p.solve();
    p.velocity = (moved(p.pose, p.solver.positions()) - world) / h;
    const int iterations = total.iterations + statistics.iterations;
    const bool converged = (k == 1 || total.converged) && statistics.converged;
    total = statistics;
    total.iterations = iterations;
    total.converged = converged;
  }
  total.milliseconds = milliseconds_since(start);
  return total;
}

void MuscleSimulation::rest(const Eigen::Isometry3d& head) {
  parts_->pose = head;
  parts_->velocity.setZero();
}

int MuscleSimulation::add_object(const TriangleMesh& mesh, const Eigen::Isometry3d& place) {
  Parts& p = *parts_;
  if (!p.contacts) fail("this simulation has no contact", "make one with contact");
  Object object;
  object.obstacle = p.contacts->scene.add_rigid(mesh);
  object.radius = mesh.V.rowwise().norm().maxCoeff();
  object.place = object.next = place;
  object.seen = p.pose.inverse() * place;
  p.contacts->scene.place(object.obstacle, object.seen);
  p.contacts->scene.add_pair(p.head.skin_vertices, object.obstacle, -1, p.solver.positions());
  p.objects.push_back(object);
  return static_cast<int>(p.objects.size()) - 1;
}

void MuscleSimulation::move_object(int object, const Eigen::Isometry3d& place) {
  if (object < 0 || object >= static_cast<int>(parts_->objects.size()))
    reject("object " + std::to_string(object), "does not exist");
  parts_->objects[static_cast<std::size_t>(object)].next = place;
}

void MuscleSimulation::set_innervation(const VectorXd& gain_per_muscle) {
  if (gain_per_muscle.size() == 0)
    parts_->innervated.reset();
  else
    parts_->innervated = innervation(parts_->head, parts_->tissue, gain_per_muscle);
}

void MuscleSimulation::set_tet_innervation(const VectorXd& gain_per_tet) {
  if (gain_per_tet.size() != 0 && (gain_per_tet.size() != parts_->tissue.soft.size() ||
                                   !(gain_per_tet.array() >= 0 && gain_per_tet.array() <= 1).all()))
    reject("innervation", "needs one gain from 0 to 1 for every soft tet");
  if (gain_per_tet.size() == 0)
    parts_->innervated.reset();
  else
    parts_->innervated = gain_per_tet;
}

void MuscleSimulation::set_wind(const Vector3d& wind) {
  if (!wind.allFinite()) reject("wind", "is not finite");
  parts_->options.air.wind = wind;
}

void MuscleSimulation::set_forces(const MatrixX3d& forces) {
  if (forces.rows() != 0 && (forces.rows() != parts_->mass.size() || !forces.allFinite()))
    reject("forces", "need one finite force for every vertex");
  parts_->forces = forces;
}

const MatrixX3d& MuscleSimulation::positions() const {
  return parts_->solver.positions();
}
MatrixX3d MuscleSimulation::skin() const {
  return parts_->drawn_skin.at(parts_->solver.positions());
}
const MatrixX3d& MuscleSimulation::velocity() const {
  return parts_->velocity;
}
JawPose MuscleSimulation::jaw() const {
  return parts_->jaw;
}
const HeadTissue& MuscleSimulation::tissue() const {
  return parts_->tissue;
}
const TissueSolver& MuscleSimulation::solver() const {
  return parts_->solver;
}
TissueSolverOptions& MuscleSimulation::solve_options() {
  return parts_->solver.options();
}

double MuscleSimulation::penetration() const {
  return parts_->contacts ? parts_->contacts->scene.penetration(parts_->solver.positions()) : 0.0;
}

MatrixX3d MuscleSimulation::contact_forces() const {
  return parts_->solver.contact_forces();
}

void MuscleSimulation::forget() {
  Parts& p = *parts_;
  p.solver.restart(p.tissue.body.rest);
  if (p.contacts) p.contacts->scene.forget();
  p.velocity.setZero();
}

}  // namespace phiz
