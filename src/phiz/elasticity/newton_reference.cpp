// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/newton_reference.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "phiz/core/parallel.h"
#include "phiz/elasticity/complementarity.h"
#include "phiz/elasticity/terms.h"
#include "phiz/geometry/operators.h"
#include "phiz/numerics/cholesky.h"

namespace phiz {

namespace {

using Matrix12d = Eigen::Matrix<double, 12, 12>;

class NewtonProblem {
 public:
  NewtonProblem(const ElasticBody& body, const std::vector<TetTarget>& targets)
      : body_(body),
        targets_(targets),
        rest_(tet_rest(body.rest, body.tets)),
        dof_(VectorXi::Constant(body.rest.rows(), -1)) {
    for (const int v : body.tets.reshaped())
      if (!body.fixed[static_cast<std::size_t>(v)] && dof_[v] < 0) dof_[v] = 0;
    for (Eigen::Index v = 0; v < dof_.size(); ++v)
      if (dof_[v] == 0) dof_[v] = free_++;
  }

  int size() const { return 3 * free_; }
  int dof(int vertex) const { return dof_[vertex]; }

  double energy(const MatrixX3d& x) const {
    return parallel_sum(body_.tets.rows(), 256, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      double sum = 0;
      for (std::ptrdiff_t t = begin; t < end; ++t) {
        const Matrix3d F = deformation_gradient(x, body_.tets, rest_, t);
        const TetTarget& target = targets_[static_cast<std::size_t>(t)];
        const double j = std::cbrt(target.volume);
        sum += weight(t) * (body_.weights.target * target_energy(F, target.gradient) +
                            body_.weights.shape * shape_energy(F, target.stretch) +
                            body_.weights.volume * j * j * volume_energy(F / j));
      }
      return sum;
    });
  }

  /// Gradient and Hessian with every tet's part made positive semidefinite.
  void derivatives(const MatrixX3d& x, VectorXd& gradient, SparseMatrixd& hessian) const {
    const Eigen::Index m = body_.tets.rows();
    std::vector<Matrix12d> blocks(static_cast<std::size_t>(m));
    std::vector<Eigen::Matrix<double, 3, 4>> forces(static_cast<std::size_t>(m));
    parallel_for(
        m,
        [&](std::ptrdiff_t t) {
          const auto s = static_cast<std::size_t>(t);
          const Matrix3d F = deformation_gradient(x, body_.tets, rest_, t);
          const TetTarget& target = targets_[s];
          const double j = std::cbrt(target.volume);
          const TermWeights& w = body_.weights;
          const Matrix3d P = w.target * target_gradient(F, target.gradient) +
                             w.shape * shape_gradient(F, target.stretch) + w.volume * j * volume_gradient(F / j);
          Matrix9d H = w.shape * shape_hessian(F, target.stretch) + w.volume * volume_hessian(F / j);
          H.diagonal().array() += 2 * w.target;
          const Eigen::SelfAdjointEigenSolver<Matrix9d> eigen(0.5 * (H + H.transpose()));
          H = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(1e-3).asDiagonal() * eigen.eigenvectors().transpose();
          const Eigen::Matrix<double, 3, 4> hats = hat_gradients(rest_.inverse_edges[s]);
          Eigen::Matrix<double, 9, 12> G = Eigen::Matrix<double, 9, 12>::Zero();
          for (int c = 0; c < 4; ++c)
            for (int column = 0; column < 3; ++column)
              G.block<3, 3>(3 * column, 3 * c) = hats(column, c) * Matrix3d::Identity();
          blocks[s] = weight(t) * G.transpose() * H * G;
          forces[s] = weight(t) * P * hats;
        },
        64);
    gradient = VectorXd::Zero(size());
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(static_cast<std::size_t>(m) * 144);
    for (Eigen::Index t = 0; t < m; ++t)
      for (int a = 0; a < 4; ++a) {
        const int row = dof_[body_.tets(t, a)];
        if (row < 0) continue;
        gradient.segment<3>(3 * row) += forces[static_cast<std::size_t>(t)].col(a);
        for (int b = 0; b < 4; ++b) {
          const int column = dof_[body_.tets(t, b)];
          if (column < 0) continue;
          for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 3; ++k)
              entries.emplace_back(3 * row + i, 3 * column + k,
                                   blocks[static_cast<std::size_t>(t)](3 * a + i, 3 * b + k));
        }
      }
    hessian.resize(size(), size());
    hessian.setFromTriplets(entries.begin(), entries.end());
  }

  MatrixX3d moved(const MatrixX3d& x, const VectorXd& p, double alpha) const {
    MatrixX3d out = x;
    for (Eigen::Index v = 0; v < x.rows(); ++v)
      if (dof_[v] >= 0) out.row(v) += alpha * p.segment<3>(3 * dof_[v]).transpose();
    return out;
  }

 private:
  double weight(Eigen::Index t) const { return rest_.volume[t] * body_.stiffness[t]; }

  const ElasticBody& body_;
  const std::vector<TetTarget>& targets_;
  TetRest rest_;
  VectorXi dof_;
  int free_ = 0;
};

/// Contact rows as columns of C^T, and their gaps.
MatrixXd contact_columns(const NewtonProblem& problem, const std::vector<ContactRow>& rows) {
  MatrixXd columns = MatrixXd::Zero(problem.size(), static_cast<Eigen::Index>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (int k = 0; k < rows[i].count; ++k) {
      const int d = problem.dof(rows[i].vertices[k]);
      if (d >= 0)
        columns.col(static_cast<Eigen::Index>(i)).segment<3>(3 * d) += rows[i].coefficients[k] * rows[i].normal;
    }
  return columns;
}

}  // namespace

SolveStatistics newton_reference(const ElasticBody& body, const std::vector<TetTarget>& targets, MatrixX3d& x,
                                 ContactScene* contacts, const NewtonOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const NewtonProblem problem(body, targets);
  SolveStatistics statistics;
  VectorXd gradient;
  SparseMatrixd hessian;
  std::unique_ptr<SparseCholesky> factor;
  double energy = problem.energy(x);
  while (statistics.iterations < options.max_iterations) {
    ++statistics.iterations;
    problem.derivatives(x, gradient, hessian);
    if (factor)
      factor->refactor(hessian);
    else
      factor = std::make_unique<SparseCholesky>(hessian);
    VectorXd p = factor->solve(-gradient);

    std::vector<ContactRow> rows;
    if (contacts != nullptr) {
      const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> positions = x;
      rows = contacts->detect({positions.data(), 3, nullptr});
      std::erase_if(rows, [&](const ContactRow& row) {
        bool moves = false;
        for (int k = 0; k < row.count; ++k) moves = moves || problem.dof(row.vertices[k]) >= 0;
        return !moves;
      });
    }
    double contact_work = 0;
    if (!rows.empty()) {
      const MatrixXd C = contact_columns(problem, rows);
      const MatrixXd response = factor->solve(C);
      MatrixXd M = C.transpose() * response;
      M.diagonal().array() += 1e-10 * M.trace() / static_cast<double>(rows.size());
      VectorXd q = C.transpose() * p;
      for (std::size_t i = 0; i < rows.size(); ++i) q[static_cast<Eigen::Index>(i)] += rows[i].gap;
      std::vector<char> active;
      const VectorXd lambda = solve_complementarity(M, q, active);
      if (lambda.size() > 0) {
        p += response * lambda;
        contact_work = lambda.dot(C.transpose() * p);
        statistics.contacts = static_cast<int>((lambda.array() > 0).count());
        statistics.residual = (gradient - C * lambda).norm();
      }
    } else {
      statistics.residual = gradient.norm();
    }
    const double longest = p.reshaped(3, p.size() / 3).colwise().norm().maxCoeff();
    const double decrease = contact_work - gradient.dot(p);
    double alpha = std::min(1.0, 2e-3 / std::max(longest, 1e-300));
    bool accepted = false;
    for (int halving = 0; halving < 20; ++halving, alpha *= 0.5) {
      const MatrixX3d trial = problem.moved(x, p, alpha);
      const double next = problem.energy(trial);
      if (next - alpha * contact_work > energy - 1e-4 * alpha * decrease + 1e-13 * std::abs(energy)) continue;
      x = trial;
      energy = next;
      accepted = true;
      break;
    }
    statistics.last_step = accepted ? alpha * longest : longest;
    if (!accepted) break;
    if (statistics.last_step <= options.step_tolerance) break;
  }
  statistics.converged = statistics.last_step <= options.step_tolerance;
  statistics.energy = energy;
  if (contacts != nullptr) statistics.penetration = contacts->penetration(x);
  statistics.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return statistics;
}

}  // namespace phiz
