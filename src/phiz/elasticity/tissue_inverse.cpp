// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/tissue_inverse.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "phiz/core/error.h"
#include "phiz/elasticity/contact_planes.h"
#include "phiz/elasticity/tissue_newton.h"
#include "phiz/elasticity/tissue_solver.h"
#include "phiz/numerics/cholesky.h"

namespace phiz {

namespace {

constexpr double millimetre = 1e-3;
constexpr double rounding = 1e-6;  ///< of objectives by the real-time engine: a micrometre, squared

VectorXi active_tets(const TissueBody& body) {
  std::vector<int> found;
  for (Eigen::Index t = 0; t < body.active.size(); ++t)
    if (body.active[t] > 0) found.push_back(static_cast<int>(t));
  return Eigen::Map<const VectorXi>(found.data(), static_cast<Eigen::Index>(found.size()));
}

/// Mean of the weighted squared distances, in square millimetres.
class Distance {
 public:
  Distance(const std::vector<ShapeTarget>& targets, const InverseOptions& options, Eigen::Index vertices)
      : targets_(targets) {
    double sum = 0;
    for (const ShapeTarget& target : targets) {
      const double length = target.normal.norm();
      if (target.vertex < 0 || target.vertex >= vertices || !target.place.allFinite() || !(target.weight >= 0) ||
          !(length == 0 || std::abs(length - 1) < 1e-3))
        reject("target " + std::to_string(&target - targets.data()),
               "needs a vertex, a finite place, a unit normal or none, and a weight of 0 or more");
      sum += target.weight;
    }
    if (!(sum > 0)) reject("inverse physics", "needs targets that have weight");
    for (const ShapeTarget& target : targets) {
      const double scale = target.weight / (sum * millimetre * millimetre);
      const bool has_plane = target.normal.squaredNorm() > 0;
      metrics_.push_back(scale * ((has_plane ? options.point_weight : options.point_weight + options.plane_weight) *
                                      Matrix3d::Identity() +
                                  options.plane_weight * target.normal * target.normal.transpose()));
    }
  }

  double value(const MatrixX3d& x) const {
    double sum = 0;
    for (std::size_t k = 0; k < targets_.size(); ++k) {
      const Vector3d d = away(x, k);
      sum += d.dot(metrics_[k] * d);
    }
    return sum;
  }
  MatrixX3d gradient(const MatrixX3d& x) const {
    MatrixX3d out = MatrixX3d::Zero(x.rows(), 3);
    for (std::size_t k = 0; k < targets_.size(); ++k)
      out.row(targets_[k].vertex) += 2 * (metrics_[k] * away(x, k)).transpose();
    return out;
  }
  MatrixX3d hessian_times(const MatrixX3d& d) const {
    MatrixX3d out = MatrixX3d::Zero(d.rows(), 3);
    for (std::size_t k = 0; k < targets_.size(); ++k) {
      const int v = targets_[k].vertex;
      out.row(v) += 2 * (metrics_[k] * d.row(v).transpose()).transpose();
    }
    return out;
  }
  /// To the places, metres.
  double root_mean_square(const MatrixX3d& x) const {
    double sum = 0, weight = 0;
    for (std::size_t k = 0; k < targets_.size(); ++k) {
      sum += targets_[k].weight * away(x, k).squaredNorm();
      weight += targets_[k].weight;
    }
    return std::sqrt(sum / weight);
  }

 private:
  Vector3d away(const MatrixX3d& x, std::size_t k) const {
    return x.row(targets_[k].vertex).transpose() - targets_[k].place;
  }

  const std::vector<ShapeTarget>& targets_;
  std::vector<Matrix3d> metrics_;
};

/// How an equilibrium follows the activations: dx = -H^-1 (df/da) da, where contacts that push stay as they are.
class Response {
 public:
  Response(const TissueEnergy& energy, const MatrixX3d& x, const VectorXi& tets,
           const std::vector<ContactRow>& contacts)
      : motion_(energy.body(), x), by_activation_(energy.gradient_by_activation(x, motion_, tets)) {
    for (const Stiffness kind : {Stiffness::exact, Stiffness::projected}) {
      SparseMatrixd H = energy.hessian(x, motion_, kind);
      hold_contacts(H, x, contacts);
      try {
        factor_.emplace(H);
        return;
      } catch (const Error&) {
        if (kind == Stiffness::projected) throw;
      }
    }
  }

  MatrixX3d forward(const Eigen::Ref<const VectorXd>& da) const {
    return motion_.expanded(-factor_->solve(by_activation_ * da));
  }
  VectorXd backward(const MatrixX3d& force) const {
    return -(by_activation_.transpose() * factor_->solve(motion_.reduced(force)).col(0));
  }

 private:
  void hold_contacts(SparseMatrixd& H, const MatrixX3d& x, const std::vector<ContactRow>& contacts) const {
    if (contacts.empty()) return;
    constexpr double firmness = 1e3;  // times the stiffness of a vertex
    const ContactPlanes planes(contacts, motion_, x, x);
    const Eigen::SparseMatrix<double> all = planes.derivative(motion_);
    Eigen::SparseMatrix<double> normals(all.rows(), planes.size());
    for (Eigen::Index i = 0; i < planes.size(); ++i) normals.col(i) = all.col(3 * i);
    const SparseMatrixd rowwise = normals;
    H += firmness * H.diagonal().mean() * SparseMatrixd(rowwise * SparseMatrixd(rowwise.transpose()));
  }

  FreeMotion motion_;
  SparseMatrixd by_activation_;
  std::optional<SparseCholesky> factor_;
};

class InverseSolve {
 public:
  InverseSolve(const TissueBody& body, const std::vector<ShapeTarget>& targets,
               const std::vector<MuscleFibres>& muscles, const InverseOptions& options, ContactScene* contacts)
      : options_(options),
        contacts_(contacts),
        energy_(body),
        tets_(active_tets(body)),
        distance_(targets, options, body.rest.rows()),
        prior_(muscles, tets_, tet_volumes(body.rest, body.tets), options.prior) {
    if (tets_.size() == 0) reject("inverse physics", "the body has no muscle");
    if (!(options.point_weight >= 0 && options.plane_weight >= 0))
      reject("inverse physics", "weights of points and planes must be 0 or more");
    if (options.exact) return;
    TissueSolverOptions fine;
    fine.step_tolerance = 1e-6;
    fine.penetration_tolerance = 1e-5;
    solver_.emplace(body, fine);
  }

  InverseResult run(const MatrixX3d& x, const std::vector<Matrix3d>& start);

 private:
  struct State {
    Activations a;
    MatrixX3d x;
    std::vector<ContactRow> contacts;  ///< that push
    double distance = 0;               ///< part of the objective
  };
  bool balance(State& state);
  double objective(const State& state) const { return state.distance + prior_.value(state.a); }
  std::vector<Matrix3d> stretches(const Activations& a) const;
  /// The step of Gauss and Newton, and by how much its model lowers the objective.
  Activations step(const Response& response, const Activations& a, const Activations& gradient, double& promised) const;

  const InverseOptions& options_;
  ContactScene* contacts_;
  TissueEnergy energy_;
  std::optional<TissueSolver> solver_;  ///< unless equilibria are to be exact
  VectorXi tets_;
  Distance distance_;
  MusclePrior prior_;
};

std::vector<Matrix3d> InverseSolve::stretches(const Activations& a) const {
  std::vector<Matrix3d> out(static_cast<std::size_t>(energy_.body().tets.rows()), Matrix3d::Identity());
  for (Eigen::Index k = 0; k < tets_.size(); ++k)
    out[static_cast<std::size_t>(tets_[k])] = activation_stretch(a.col(k));
  return out;
}

bool InverseSolve::balance(State& state) {
  const std::vector<Matrix3d> all = stretches(state.a);
  energy_.set_activation(all);
  state.contacts.clear();
  SolveStatistics statistics;
  if (solver_) {
    solver_->set_activation(all);
    statistics = solver_->solve(state.x, contacts_);
    state.x = solver_->positions();
    if (contacts_ != nullptr) {
      constexpr double touching = 2e-5;  // metres
      const MatrixX3d forces = solver_->contact_forces();
      for (const ContactRow& row : detect_afresh(*contacts_, state.x))
        if (row.gap < touching && forces.row(row.vertices[0]) * row.normal > 0) state.contacts.push_back(row);
    }
  } else {
    std::vector<ContactForce> forces;
    statistics = solve_static(energy_, state.x, {}, contacts_, &forces);
    for (const ContactForce& force : forces) state.contacts.push_back(force.row);
  }
  state.distance = distance_.value(state.x);
  return statistics.converged;
}

Activations InverseSolve::step(const Response& response, const Activations& a, const Activations& gradient,
                               double& promised) const {
  constexpr int most = 300;
  constexpr double enough = 1e-3;
  const Activations curvature = prior_.curvature(a);
  const auto apply = [&](const VectorXd& v) -> VectorXd {
    return response.backward(distance_.hessian_times(response.forward(v))) +
           prior_.curvature_times(curvature, v.reshaped(6, a.cols())).reshaped();
  };
  VectorXd da = VectorXd::Zero(gradient.size()), r = -gradient.reshaped();
  VectorXd z = r.cwiseQuotient(curvature.reshaped()), direction = z;
  double rz = r.dot(z);
  const double start = rz;
  for (int k = 0; k < most && rz > enough * enough * start; ++k) {
    const VectorXd image = apply(direction);
    const double alpha = rz / direction.dot(image);
    da += alpha * direction;
    r -= alpha * image;
    z = r.cwiseQuotient(curvature.reshaped());
    const double next = r.dot(z);
    direction = z + next / rz * direction;
    rz = next;
  }
  // The residual is -gradient - A da, so the model at da is gradient.da + da.A.da / 2.
  promised = -0.5 * (gradient.reshaped().dot(da) - r.dot(da));
  return da.reshaped(6, gradient.cols());
}

InverseResult InverseSolve::run(const MatrixX3d& x, const std::vector<Matrix3d>& start) {
  State state{Activations(neutral_activation().replicate(1, tets_.size())), x, {}, 0};
  if (!start.empty())
    for (Eigen::Index k = 0; k < tets_.size(); ++k)
      state.a.col(k) = activation_of(start[static_cast<std::size_t>(tets_[k])]);
  if (solver_) solver_->restart(x);
  if (!balance(state)) fail("inverse physics found no equilibrium under the activations to start from");

  InverseResult result;
  prior_.fit(state.a);
  result.objectives.push_back(objective(state));
  result.start = distance_.root_mean_square(state.x);
  double first_gradient = 0;
  for (;;) {
    energy_.set_activation(stretches(state.a));
    const Response response(energy_, state.x, tets_, state.contacts);
    const Activations gradient =
        response.backward(distance_.gradient(state.x)).reshaped(6, tets_.size()) + prior_.gradient(state.a);
    if (first_gradient == 0) first_gradient = gradient.norm();
    result.gradient = first_gradient > 0 ? gradient.norm() / first_gradient : 0;
    const double now = objective(state);
    double promised = 0;
    Activations da = Activations::Zero(6, tets_.size());
    if (first_gradient > 0) da = step(response, state.a, gradient, promised);
    result.converged = promised <= options_.tolerance * now + (options_.exact ? 0 : rounding);
    if (result.converged || result.iterations == options_.max_iterations) break;

    constexpr double longest = 0.3;
    double share = std::min(1.0, longest / da.cwiseAbs().maxCoeff());
    bool found = false;
    for (int halving = 0; halving < 8 && !found; ++halving, share *= 0.5) {
      State trial = state;
      trial.a += share * da;
      trial.x += response.forward((trial.a - state.a).reshaped());
      prior_.fit(trial.a);
      if (balance(trial) && objective(trial) < now - 1e-4 * share * promised) {
        state = std::move(trial);
        found = true;
      } else if (solver_) {
        solver_->restart(state.x);
      }
    }
    prior_.fit(state.a);
    if (!found) break;
    ++result.iterations;
    result.objectives.push_back(objective(state));
  }
  result.stretches = stretches(state.a);
  result.contractions = prior_.contractions();
  result.distance = distance_.root_mean_square(state.x);
  result.x = std::move(state.x);
  return result;
}

}  // namespace

InverseResult find_activations(const TissueBody& body, const std::vector<ShapeTarget>& targets,
                               const std::vector<MuscleFibres>& muscles, const MatrixX3d& x,
                               const std::vector<Matrix3d>& start, const InverseOptions& options,
                               ContactScene* contacts) {
  if (x.rows() != body.rest.rows() || !x.allFinite())
    reject("inverse physics", "needs " + std::to_string(body.rest.rows()) + " finite positions to start from");
  if (!start.empty() && static_cast<Eigen::Index>(start.size()) != body.tets.rows())
    reject("inverse physics", "needs a stretch for every tet to start from, or none");
  return InverseSolve(body, targets, muscles, options, contacts).run(x, start);
}

}  // namespace phiz
