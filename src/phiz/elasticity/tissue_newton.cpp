// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/tissue_newton.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "phiz/core/error.h"
#include "phiz/numerics/cholesky.h"

namespace phiz {

namespace {

/// Newton's step from the true Hessian where that is positive definite, else from a projected one, shifted as little as
/// makes it so.
class NewtonStep {
 public:
  explicit NewtonStep(const TissueEnergy& energy) : energy_(energy) {}

  VectorXd operator()(const MatrixX3d& x, const FreeMotion& motion, const VectorXd& gradient) {
    constexpr double least_shift = 1e-12, first_shift = 1e-8, most_shift = 1e4;
    for (const Stiffness kind : {Stiffness::exact, Stiffness::projected}) {
      const SparseMatrixd H = energy_.hessian(x, motion, kind);
      const double scale = H.diagonal().cwiseAbs().mean();
      double shift = least_shift;
      while (shift <= (kind == Stiffness::exact ? least_shift : most_shift)) {
        if (factorise(H, shift * scale)) {
          const VectorXd p = factor_->solve(-gradient);
          if (p.allFinite() && p.dot(gradient) < 0) return p;
        }
        shift = std::max(first_shift, 100 * shift);
      }
    }
    return -gradient;
  }

 private:
  bool factorise(SparseMatrixd H, double shift) {
    H.diagonal().array() += shift;
    try {
      if (factor_)
        factor_->refactor(H);
      else
        factor_.emplace(H);
      return true;
    } catch (const Error&) {
      return false;
    }
  }

  const TissueEnergy& energy_;
  std::optional<SparseCholesky> factor_;
};

}  // namespace

SolveStatistics solve_static(const TissueEnergy& energy, MatrixX3d& x, const NewtonStaticOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  if (x.rows() != energy.body().rest.rows() || !x.allFinite())
    reject("static solve", "needs " + std::to_string(energy.body().rest.rows()) + " finite positions");
  NewtonStep step(energy);
  put_on_slides(energy.body(), x);
  SolveStatistics statistics;
  double value = energy.value(x);
  for (;;) {
    const FreeMotion motion(energy.body(), x);
    VectorXd magnitude;
    const VectorXd g = motion.reduced(energy.gradient(x, &magnitude));
    double scale2 = 0;
    for (Eigen::Index v = 0; v < magnitude.size(); ++v)
      if (motion.first(v) >= 0) scale2 += magnitude[v] * magnitude[v];
    statistics.residual = scale2 > 0 ? g.norm() / std::sqrt(scale2) : 0;
    statistics.converged = statistics.residual <= options.residual_tolerance;
    if (statistics.converged || statistics.iterations == options.max_iterations) break;
    ++statistics.iterations;
    const VectorXd p = step(x, motion, g);
    const MatrixX3d move = motion.expanded(p);
    const double longest = move.rowwise().norm().maxCoeff();
    double alpha = std::min(1.0, options.longest_step / std::max(longest, 1e-300));
    bool accepted = false;
    for (int halving = 0; halving < 40 && !accepted; ++halving, alpha *= 0.5) {
      MatrixX3d trial = x + alpha * move;
      put_on_slides(energy.body(), trial);
      const double next = energy.value(trial);
      // Near the solution rounding hides the decrease.
      accepted = next <= value + 1e-4 * alpha * g.dot(p) + 1e-14 * std::abs(value);
      if (!accepted) continue;
      statistics.last_step = alpha * longest;
      x = trial;
      value = next;
    }
    if (!accepted) break;
  }
  statistics.energy = value;
  statistics.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return statistics;
}

}  // namespace phiz
