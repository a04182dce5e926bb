// SPDX-License-Identifier: GPL-3.0-or-later
/// Limited-memory BFGS on a prefactored matrix (Liu, Bouaziz and Kavan 2017) in the compact form of Byrd, Nocedal and
/// Schnabel (1994): H = gamma A^-1 + [S, gamma Z] M [S, gamma Z]^T with Z = A^-1 Y. The compact form gives products
/// with sparse vectors and Schur complements C H C^T without further solves.
#pragma once

#include <hwy/aligned_allocator.h>

#include <Eigen/Core>
#include <vector>

namespace phiz {

using AlignedVector = hwy::AlignedFreeUniquePtr<double[]>;

class LowRankInverse {
 public:
  /// Vectors of `size` doubles; at most `history` pairs. `gamma`: scale of A^-1 before the first pair.
  LowRankInverse(std::ptrdiff_t size, int history, double gamma = 1);

  void clear();
  int pairs() const { return count_; }
  double gamma() const { return gamma_; }

  /// Adds the pair s (a step), y (the change of the gradient over it), z = A^-1 y. Pairs without positive curvature are
  /// refused. Returns whether it was taken.
  bool add(const double* s, const double* y, const double* z);

  /// [S^T v; gamma Z^T v] of a dense vector.
  Eigen::VectorXd project(const double* v) const;
  /// Entries [first, first + count) of all S and gamma Z: `count` x 2 pairs().
  Eigen::MatrixXd rows(std::ptrdiff_t first, std::ptrdiff_t count) const;
  /// M u for u = [S^T v; gamma Z^T v], 2 pairs() entries.
  Eigen::VectorXd middle(const Eigen::VectorXd& u) const;
  /// M, 2 pairs() square.
  Eigen::MatrixXd middle() const;
  /// y <- sign * (gamma * inverse_v + [S, gamma Z] u).
  void combine(const double* inverse_v, const Eigen::VectorXd& u, double sign, double* y) const;

 private:
  /// S and Z, oldest pair first.
  std::vector<const double*> columns() const;
  const double* s(int pair) const { return s_[static_cast<std::size_t>(slot(pair))].get(); }
  const double* z(int pair) const { return z_[static_cast<std::size_t>(slot(pair))].get(); }
  int slot(int pair) const { return (first_ + pair) % history_; }

  std::ptrdiff_t size_;
  int history_;
  int first_ = 0, count_ = 0;
  double gamma_ = 1;
  std::vector<AlignedVector> s_, z_;
  Eigen::MatrixXd sy_, yz_;  ///< s_i . y_j and y_i . z_j, oldest first
};

/// Products left_k . right in one pass, the same bits for any number of threads.
Eigen::VectorXd dots(const std::vector<const double*>& left, const double* right, std::ptrdiff_t size);
double dot(const double* left, const double* right, std::ptrdiff_t size);

}  // namespace phiz
