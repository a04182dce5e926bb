// SPDX-License-Identifier: GPL-3.0-or-later
/// Sparse Cholesky factorisation with the symbolic analysis kept (CHOLMOD, supernodal, METIS nested dissection).
#pragma once

#include <memory>

#include "phiz/geometry/mesh.h"

namespace phiz {

/// Factor of a symmetric positive definite matrix A. OpenBLAS is held to one thread from the first construction on: its
/// workers spin, and one thread keeps results the same on every machine.
class SparseCholesky {
 public:
  /// Analyses and factorises A, stored whole: of the two triangles one is read. Throws phiz::Error(failure) when A
  /// is not square, not finite or not positive definite, naming the row where the factorisation broke down.
  explicit SparseCholesky(const SparseMatrixd& A);
  ~SparseCholesky();
  SparseCholesky(SparseCholesky&&) noexcept;
  SparseCholesky& operator=(SparseCholesky&&) noexcept;

  /// Factorises new values with the same pattern, reusing the analysis. Throws phiz::Error(failure) as the constructor
  /// does, and when the pattern differs; after an error the factor must be refactorised before the next solve.
  void refactor(const SparseMatrixd& A);

  /// A^-1 B, one right-hand side per column. Safe to call from several threads at once.
  MatrixXd solve(const MatrixXd& B) const;
  void solve_in_place(Eigen::Ref<MatrixXd> B) const;

  Eigen::Index rows() const;
  Eigen::Index factor_entries() const;  ///< stored entries of the factor, zeros inside of supernodes included

 private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};

}  // namespace phiz
