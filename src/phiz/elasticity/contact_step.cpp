// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/contact_step.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "phiz/core/error.h"
#include "phiz/elasticity/complementarity.h"
#include "phiz/elasticity/coulomb.h"

namespace phiz {

namespace {

constexpr double touching = 1e-9;      // metres
constexpr double overlapping = 1e-13;  // metres

/// Rows (numbers 3 i + k) that hold like a bilateral joint: contacts that touch, or are too deep, and push, and their
/// slip where friction is below its limit.
std::vector<Eigen::Index> held_rows(const ContactState& state, double friction, const Eigen::Matrix3Xd& forces) {
  constexpr double below_limit = 1 - 1e-9;
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < forces.cols(); ++i) {
    if (forces(0, i) <= 0 || state.separation(0, i) > touching) continue;
    rows.push_back(3 * i);
    const bool sticks = forces.col(i).tail<2>().norm() < below_limit * friction * forces(0, i) &&
                        state.separation.col(i).tail<2>().norm() <= touching;
    if (sticks) rows.insert(rows.end(), {3 * i + 1, 3 * i + 2});
  }
  return rows;
}

bool same_pattern(const SparseMatrixd& A, const SparseMatrixd& B) {
  return A.rows() == B.rows() && A.nonZeros() == B.nonZeros() &&
         std::equal(A.outerIndexPtr(), A.outerIndexPtr() + A.rows() + 1, B.outerIndexPtr()) &&
         std::equal(A.innerIndexPtr(), A.innerIndexPtr() + A.nonZeros(), B.innerIndexPtr());
}

}  // namespace

bool ContactStep::factorise(const SparseMatrixd& H) {
  try {
    if (factor_ && same_pattern(H, factorised_)) {
      factor_->refactor(H);
    } else {
      factor_.reset();
      factor_.emplace(H);
      factorised_ = H;
    }
    return true;
  } catch (const Error&) {
    return false;
  }
}

VectorXd ContactStep::operator()(const ContactState& state, double friction, Eigen::Matrix3Xd& forces) {
  constexpr double least_shift = 1e-12, first_shift = 1e-8, most_shift = 1e4;
  const std::vector<Eigen::Index> held = held_rows(state, friction, forces);
  Eigen::SparseMatrix<double> joints(state.motion.size(), static_cast<Eigen::Index>(held.size()));
  VectorXd openings(joints.cols());
  for (Eigen::Index k = 0; k < joints.cols(); ++k) {
    joints.col(k) = state.derivative.col(held[static_cast<std::size_t>(k)]);
    openings[k] = state.separation.reshaped()[held[static_cast<std::size_t>(k)]];
  }
  const SparseMatrixd product = joints * Eigen::SparseMatrix<double>(joints.transpose());
  for (const Stiffness kind : {Stiffness::exact, Stiffness::projected}) {
    SparseMatrixd H = energy_.hessian(state.x, state.motion, kind);
    const double scale = H.diagonal().cwiseAbs().mean();
    VectorXd gradient = state.gradient;
    if (!held.empty()) {
      H += scale * product;
      gradient += scale * (joints * openings);
    }
    double shift = least_shift;
    while (shift <= (kind == Stiffness::exact ? least_shift : most_shift)) {
      SparseMatrixd shifted = H;
      shifted.diagonal().array() += shift * scale;
      if (factorise(shifted)) {
        Eigen::Matrix3Xd next = forces;
        const VectorXd p = solve(state, gradient, friction, next);
        if (p.allFinite()) {
          // What the joints added to H carried part of the force, and would pull at contacts that open.
          const VectorXd carried = scale * (openings + joints.transpose() * p);
          for (Eigen::Index k = 0; k < carried.size(); ++k)
            next.reshaped()[held[static_cast<std::size_t>(k)]] -= carried[k];
          for (Eigen::Index i = 0; i < next.cols(); ++i) {
            next(0, i) = std::max(0.0, next(0, i));
            const double length = next.col(i).tail<2>().norm(), limit = friction * next(0, i);
            if (length > limit) next.col(i).tail<2>() *= limit / length;
          }
          forces = next;
          is_exact_ = kind == Stiffness::exact;
          return p;
        }
      }
      shift = std::max(first_shift, 100 * shift);
    }
  }
  forces.setZero();
  is_exact_ = false;
  return -state.gradient;
}

VectorXd ContactStep::solve(const ContactState& state, const VectorXd& gradient, double friction,
                            Eigen::Matrix3Xd& forces) const {
  const VectorXd alone = factor_->solve(-gradient);
  const Eigen::Index rows = friction > 0 ? 3 : 1;  // per contact
  const auto after = [&](const VectorXd& p) -> Eigen::Matrix3Xd {
    return state.separation + (state.derivative.transpose() * p).reshaped(3, forces.cols());
  };
  std::vector<char> working(static_cast<std::size_t>(forces.cols()), 0);
  std::vector<Eigen::Index> contacts;
  MatrixXd columns(state.motion.size(), 0), response(state.motion.size(), 0);
  const Eigen::Matrix3Xd unheld = after(alone);
  Eigen::Matrix3Xd next = Eigen::Matrix3Xd::Zero(3, forces.cols());
  VectorXd p = alone;
  Eigen::Matrix3Xd separation = unheld;
  for (;;) {
    const Eigen::Index known = columns.cols();
    for (Eigen::Index i = 0; i < forces.cols(); ++i) {
      const bool first = contacts.empty() || known == 0;
      const bool wanted = first ? unheld(0, i) < idle_gap || forces(0, i) > 0 : separation(0, i) < -overlapping;
      if (!wanted || working[static_cast<std::size_t>(i)] != 0) continue;
      working[static_cast<std::size_t>(i)] = 1;
      contacts.push_back(i);
    }
    const Eigen::Index size = rows * static_cast<Eigen::Index>(contacts.size());
    if (size == known) break;
    columns.conservativeResize(Eigen::NoChange, size);
    response.conservativeResize(Eigen::NoChange, size);
    for (Eigen::Index k = known; k < size; ++k)
      columns.col(k) = state.derivative.col(3 * contacts[static_cast<std::size_t>(k / rows)] + k % rows);
    response.rightCols(size - known) = factor_->solve(columns.rightCols(size - known));
    MatrixXd M = columns.transpose() * response;
    M = 0.5 * (M + M.transpose()).eval();
    M.diagonal().array() += 1e-11 * M.trace() / static_cast<double>(size);  // some rows may say the same
    VectorXd q(size), y(size);
    for (Eigen::Index k = 0; k < size; ++k) {
      const Eigen::Index i = contacts[static_cast<std::size_t>(k / rows)];
      q[k] = unheld(k % rows, i);
      y[k] = forces(k % rows, i);
    }
    if (friction > 0) {
      solve_coulomb(M, q, friction, y);
    } else {
      std::vector<char> active(static_cast<std::size_t>(size));
      for (Eigen::Index k = 0; k < size; ++k) active[static_cast<std::size_t>(k)] = y[k] > 0 || q[k] < 0;
      y = solve_complementarity(M, q, active);
      if (y.size() != size) y = VectorXd::Zero(size);
    }
    for (Eigen::Index k = 0; k < size; ++k) next(k % rows, contacts[static_cast<std::size_t>(k / rows)]) = y[k];
    // One solve for the gradient and the forces, which all but cancel near the solution.
    p = factor_->solve(columns * y - gradient);
    separation = after(p);
  }
  forces = next;
  return p;
}

}  // namespace phiz
