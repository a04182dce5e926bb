// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/tissue_newton.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <string>

#include "phiz/core/error.h"
#include "phiz/core/random.h"
#include "phiz/elasticity/contact_step.h"
#include "phiz/elasticity/static_residual.h"
#include "phiz/geometry/operators.h"

namespace phiz {

namespace {

using Clock = std::chrono::steady_clock;

/// With fixed planes, contacts that push may be this far from touching, and slip this far from where friction says.
constexpr double gap_tolerance = 1e-9;  // metres
constexpr int most_nudges = 3;

class StaticSolve {
 public:
  StaticSolve(const TissueEnergy& energy, MatrixX3d& x, const NewtonStaticOptions& options, ContactScene* contacts)
      : energy_(energy),
        options_(options),
        contacts_(contacts),
        x_(x),
        reference_(options.friction_reference.rows() > 0 ? options.friction_reference : x),
        force_scale_(energy.body()),
        step_(energy) {
    // Laws are differences of numbers of the size of the moduli.
    const VectorXd volume = tet_volumes(energy.body().rest, energy.body().tets);
    for (Eigen::Index t = 0; t < volume.size(); ++t) {
      const Moduli& moduli = energy.body().moduli[static_cast<std::size_t>(t)];
      energy_rounding_ += 2e-16 * volume[t] * (moduli.mu + moduli.lambda);
    }
  }

  SolveStatistics run(std::vector<ContactForce>* forces) {
    value_ = energy_.value(x_);
    if (contacts_ == nullptr) {
      statistics_.converged = solve_with_planes(options_.residual_tolerance);
    } else {
      alternate();
    }
    statistics_.energy = value_;
    const TissueBody& body = energy_.body();
    statistics_.volume_change = tet_volumes(x_, body.tets).sum() / tet_volumes(body.rest, body.tets).sum() - 1;
    statistics_.milliseconds = milliseconds_since(start_);
    if (forces != nullptr) *forces = pushing(planes_.separation(x_));
    return statistics_;
  }

 private:
  void alternate();
  void find_planes();
  /// Newton's method until the residual is small, with the planes as they are. Returns whether it is.
  bool solve_with_planes(double tolerance);
  ContactState evaluate(double& scale) const;
  double residual(const ContactState& state, double scale) const;
  /// Where the Hessian was not positive definite to the end, forces may be in balance on a saddle, e.g. of a flattened
  /// body: moves a little off it.
  void leave_saddle(const FreeMotion& motion);
  /// How far contacts are from touching where they push, and from slipping the way that friction says, metres.
  double disagreement(const ContactState& state, double scale) const;
  /// Takes as much of the step p as lowers the merit. Returns the share, 0 for none.
  double search(const ContactState& state, const VectorXd& p, double& longest);
  /// Penetration of the planes and work of friction, as weighted in the merit.
  double contact_merit(const Eigen::Matrix3Xd& separation) const;
  std::vector<ContactForce> pushing(const Eigen::Matrix3Xd& separation) const;
  double longest_step() const {
    return contacts_ == nullptr ? options_.longest_step
                                : std::min(options_.longest_step, contacts_->options().depth_limit / 3);
  }

  const TissueEnergy& energy_;
  const NewtonStaticOptions& options_;
  ContactScene* contacts_;
  MatrixX3d& x_;
  MatrixX3d reference_;
  ForceScale force_scale_;
  double energy_rounding_ = 0;  ///< joules
  ContactStep step_;
  ContactPlanes planes_;
  MatrixX3d detected_at_;
  Eigen::Matrix3Xd forces_;  ///< of the contacts with the planes, each in its frame
  double penalty_ = 0;       ///< newtons, more than any pressure
  double value_ = 0;
  int round_ = 0, nudges_ = 0;
  SolveStatistics statistics_;
  Clock::time_point start_ = Clock::now();
};

std::vector<ContactForce> StaticSolve::pushing(const Eigen::Matrix3Xd& separation) const {
  std::vector<ContactForce> out;
  for (Eigen::Index i = 0; i < forces_.cols(); ++i) {
    if (forces_(0, i) <= 0) continue;
    ContactForce force{planes_.rows()[static_cast<std::size_t>(i)], forces_(0, i), Vector3d::Zero()};
    force.row.gap = separation(0, i);
    force.friction = planes_.frame(i).rightCols<2>() * forces_.col(i).tail<2>();
    out.push_back(force);
  }
  return out;
}

void StaticSolve::find_planes() {
  const std::vector<ContactForce> before = pushing(planes_.separation(x_));
  planes_ = ContactPlanes(detect_afresh(*contacts_, x_), FreeMotion(energy_.body(), x_), x_, reference_);
  detected_at_ = x_;
  forces_ = Eigen::Matrix3Xd::Zero(3, planes_.size());
  penalty_ = 0;
  // Both lists are in the scene's order.
  const auto key = [](const ContactRow& row) { return std::make_pair(row.pair, row.vertices[0]); };
  std::size_t next = 0;
  for (Eigen::Index i = 0; i < planes_.size(); ++i) {
    const auto here = key(planes_.rows()[static_cast<std::size_t>(i)]);
    for (std::size_t k = next; k < before.size(); ++k) {
      if (key(before[k].row) != here) continue;
      next = k + 1;
      forces_.col(i) = planes_.frame(i).transpose() * before[k].friction;
      forces_(0, i) = before[k].pressure;
      break;
    }
  }
}

void StaticSolve::alternate() {
  constexpr double turning_back = -0.3, least_share = 0.02;
  MatrixX3d last_move = MatrixX3d::Zero(x_.rows(), 3);
  double share = 1;
  for (round_ = 0; round_ < options_.max_rounds; ++round_) {
    find_planes();
    const MatrixX3d before = x_;
    // The first planes do not deserve many digits.
    const double loose = round_ == 0 ? 1e-3 : round_ == 1 ? 1e-5 : 0;
    const bool solved = solve_with_planes(std::max(loose, options_.residual_tolerance));
    const MatrixX3d move = x_ - before;
    const double longest = move.rowwise().norm().maxCoeff();
    statistics_.penetration = contacts_->penetration(x_);
    statistics_.converged = solved && statistics_.residual <= options_.residual_tolerance &&
                            longest <= options_.state_tolerance &&
                            statistics_.penetration <= options_.penetration_tolerance;
    if (statistics_.converged || statistics_.iterations >= options_.max_iterations) return;
    // The same planes would be found again: what is too deep is pinned there.
    if (solved && loose <= options_.residual_tolerance && longest == 0) return;
    // Where planes and states call each other in a circle, the states between them are nearer to the solution.
    if (round_ > 2 && move.cwiseProduct(last_move).sum() < turning_back * move.norm() * last_move.norm())
      share = std::max(least_share, 0.6 * share);
    else
      share = std::min(1.0, 1.2 * share);
    last_move = move;
    if (share == 1 || round_ + 1 == options_.max_rounds) continue;
    x_ = before + share * move;
    put_on_slides(energy_.body(), x_);
    value_ = energy_.value(x_);
  }
}

ContactState StaticSolve::evaluate(double& scale) const {
  ContactState state{x_, FreeMotion(energy_.body(), x_), {}, {}, {}};
  VectorXd magnitude;
  state.gradient = state.motion.reduced(energy_.gradient(x_, &magnitude));
  state.separation = planes_.separation(x_);
  state.derivative = planes_.derivative(state.motion);
  scale = force_scale_(state.motion, magnitude);
  return state;
}

double StaticSolve::residual(const ContactState& state, double scale) const {
  if (state.motion.size() == 0) return 0;
  return (state.gradient - state.derivative * forces_.reshaped()).norm() / scale;
}

double StaticSolve::disagreement(const ContactState& state, double scale) const {
  double most = 0;
  const double weak = options_.residual_tolerance * scale;
  for (Eigen::Index i = 0; i < forces_.cols(); ++i) {
    const double gap = state.separation(0, i), limit = options_.friction * forces_(0, i);
    most = std::max(most, forces_(0, i) > weak ? std::abs(gap) : -gap);
    const auto slip = state.separation.col(i).tail<2>();
    if (limit > weak) most = std::max(most, slip.norm() + slip.dot(forces_.col(i).tail<2>()) / limit);
  }
  return most;
}

double StaticSolve::contact_merit(const Eigen::Matrix3Xd& separation) const {
  double sum = 0;
  for (Eigen::Index i = 0; i < separation.cols(); ++i)
    sum += penalty_ * std::max(0.0, -separation(0, i)) +
           options_.friction * forces_(0, i) * separation.col(i).tail<2>().norm();
  return sum;
}

double StaticSolve::search(const ContactState& state, const VectorXd& p, double& longest) {
  // l1 merit: exact where the penalty is above every pressure. Planes are linear, so a whole step ends every
  // penetration of theirs, and from then on the energy falls monotonically.
  if (forces_.cols() > 0) penalty_ = std::max(penalty_, 2 * forces_.row(0).maxCoeff());
  const MatrixX3d move = state.motion.expanded(p);
  longest = move.rowwise().norm().maxCoeff();
  const Eigen::Matrix3Xd linear = state.separation + (state.derivative.transpose() * p).reshaped(3, forces_.cols());
  const double merit = value_ + contact_merit(state.separation);
  const double slope = std::min(0.0, state.gradient.dot(p) + contact_merit(linear) - contact_merit(state.separation));
  // Near the solution rounding hides the decrease.
  const double weight = std::abs(energy_.mass().dot(x_ * energy_.body().gravity));
  const double rounding =
      1e-14 * (std::abs(value_) + weight) + energy_rounding_ + 1e-15 * penalty_ * static_cast<double>(forces_.cols());
  double alpha = std::min(1.0, longest_step() / std::max(longest, 1e-300));
  for (int halving = 0; halving < 40; ++halving, alpha *= 0.5) {
    MatrixX3d trial = x_ + alpha * move;
    put_on_slides(energy_.body(), trial);
    const double next = energy_.value(trial);
    if (!(next + contact_merit(planes_.separation(trial)) <= merit + 1e-4 * alpha * slope + rounding)) continue;
    x_ = trial;
    value_ = next;
    return alpha;
  }
  return 0;
}

void StaticSolve::leave_saddle(const FreeMotion& motion) {
  constexpr double distance = 1e-6;  // metres
  Random random(static_cast<std::uint64_t>(++nudges_));
  x_ += distance * motion.expanded(VectorXd::NullaryExpr(motion.size(), [&random] { return random.normal(); }));
  put_on_slides(energy_.body(), x_);
  value_ = energy_.value(x_);
}

bool StaticSolve::solve_with_planes(double tolerance) {
  for (;;) {
    double scale = 0;
    const ContactState state = evaluate(scale);
    statistics_.residual = residual(state, scale);
    statistics_.contacts = static_cast<int>((forces_.row(0).array() > 0).count());
    if (statistics_.residual <= tolerance && disagreement(state, scale) <= gap_tolerance) {
      if (step_.is_exact() || nudges_ == most_nudges) return true;
      leave_saddle(state.motion);
      continue;
    }
    if (statistics_.iterations >= options_.max_iterations) return false;
    // Planes hold for where they were found.
    if (contacts_ != nullptr && (x_ - detected_at_).rowwise().norm().maxCoeff() > contacts_->options().margin)
      return false;
    ++statistics_.iterations;
    TraceEntry entry;
    entry.iteration = statistics_.iterations;
    entry.round = round_;
    entry.energy = value_;
    entry.residual = statistics_.residual;
    entry.contacts = statistics_.contacts;
    if (state.separation.cols() > 0) entry.violation = std::max(0.0, -state.separation.row(0).minCoeff());
    const VectorXd p = step_(state, options_.friction, forces_);
    double longest = 0;
    entry.step_length = search(state, p, longest);
    entry.last_step = entry.step_length * longest;
    entry.milliseconds = milliseconds_since(start_);
    if (options_.trace != nullptr) options_.trace->push_back(entry);
    if (entry.step_length == 0) return false;
    statistics_.last_step = entry.last_step;
  }
}

void require_sense(const TissueEnergy& energy, const MatrixX3d& x, const NewtonStaticOptions& options) {
  const Eigen::Index n = energy.body().rest.rows();
  if (x.rows() != n || !x.allFinite()) reject("static solve", "needs " + std::to_string(n) + " finite positions");
  if (!(options.friction >= 0 && std::isfinite(options.friction)))
    reject("static solve", "a coefficient of friction must be 0 or more");
  const MatrixX3d& reference = options.friction_reference;
  if (reference.rows() != 0 && (reference.rows() != n || !reference.allFinite()))
    reject("static solve", "needs a finite reference for friction for every vertex");
}

}  // namespace

SolveStatistics solve_static(const TissueEnergy& energy, MatrixX3d& x, const NewtonStaticOptions& options,
                             ContactScene* contacts, std::vector<ContactForce>* forces) {
  require_sense(energy, x, options);
  put_on_slides(energy.body(), x);
  return StaticSolve(energy, x, options, contacts).run(forces);
}

}  // namespace phiz
