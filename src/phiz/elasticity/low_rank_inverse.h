// SPDX-License-Identifier: GPL-3.0-or-later
/// Limited-memory BFGS on a prefactored matrix (Liu, Bouaziz and Kavan 2017) in the compact form of Byrd, Nocedal and
/// Schnabel (1994): H = gamma A^-1 + [S, gamma Z] M [S, gamma Z]^T with Z = A^-1 Y. The compact form gives products
/// with sparse vectors and Schur complements C H C^T without further solves.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "phiz/elasticity/vector_kernel.h"

namespace phiz {

class LowRankInverse {
 public:
  /// Vectors of `size` floats; at most `history` pairs, no more than most_history. `gamma`: scale of A^-1 before the
  /// first pair.
  LowRankInverse(std::ptrdiff_t size, int history, double gamma = 1);

  void clear();
  int pairs() const { return count_; }
  int history() const { return history_; }
  double gamma() const { return gamma_; }

  /// Where a run of steps starts: g is the gradient there.
  void start(const float* g);
  /// After the step s, over which the gradient changed by y to g, with z = A^-1 y: takes the pair, the oldest one
  /// leaves. A pair without positive curvature is not taken.
  void add(const float* s, const float* y, const float* z, const float* g);

  /// S and Z, oldest pair first.
  std::vector<const float*> columns() const;
  /// [S^T v; gamma Z^T v].
  Eigen::VectorXd products(const float* v) const;
  /// [S^T g; gamma Z^T g] of the last gradient.
  Eigen::VectorXd projection() const;
  static constexpr int most_history = 16;
  using Rows = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, 2 * most_history>;
  /// Entries first, first + 1 and first + 2 of all S and gamma Z: 3 x 2 pairs().
  Rows rows(std::ptrdiff_t first) const;
  /// M u for u = [S^T v; gamma Z^T v], 2 pairs() entries.
  Eigen::VectorXd middle(const Eigen::VectorXd& u) const;
  /// M, 2 pairs() square.
  Eigen::MatrixXd middle() const;
  /// y <- sign * (gamma * inverse_v + [S, gamma Z] u).
  void apply(const float* inverse_v, const Eigen::VectorXd& u, double sign, float* y) const;

 private:
  const float* s(int pair) const { return s_[static_cast<std::size_t>(slot(pair))].get(); }
  const float* z(int pair) const { return z_[static_cast<std::size_t>(slot(pair))].get(); }
  int slot(int pair) const { return (first_ + pair) % history_; }

  std::ptrdiff_t size_;
  int history_;
  int first_ = 0, count_ = 0;
  double gamma_ = 1;
  std::vector<FloatVector> s_, z_;
  Eigen::MatrixXd sy_, yz_;  ///< s_i . y_j and y_i . z_j, oldest first
  Eigen::VectorXd sg_, zg_;  ///< s_i . g and z_i . g
};

}  // namespace phiz
