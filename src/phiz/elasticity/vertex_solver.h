// SPDX-License-Identifier: GPL-3.0-or-later
/// Repeated solves with one sparse positive definite matrix that acts alike on x, y and z: a supernodal Cholesky factor
/// in single precision, in the layout that suits three right-hand sides at once. It serves iterations that correct its
/// error: about a millionth, times the condition of the matrix at worst.
#pragma once

#include <memory>

#include "phiz/geometry/mesh.h"

namespace phiz {

/// Order of elimination with little fill (METIS nested dissection, postordered): entry i is the old row of new row i.
/// `pattern`: symmetric, structure only.
VectorXi elimination_order(const SparseMatrixd& pattern);

class VertexSolver {
 public:
  /// Factorises A (symmetric positive definite, both triangles given), whose rows are in an elimination_order already.
  /// Throws phiz::Error(failure) if A is not positive definite.
  explicit VertexSolver(const SparseMatrixd& A);
  ~VertexSolver();
  VertexSolver(VertexSolver&&) noexcept;
  VertexSolver& operator=(VertexSolver&&) noexcept;

  std::ptrdiff_t rows() const;
  std::ptrdiff_t factor_entries() const;

  /// x <- A^-1 x for three right-hand sides, row-interleaved: rows() x 4 floats, of which the last becomes zero;
  /// 64-byte aligned. The same bits for any number of threads. Not to be called from two threads at once on one object.
  void solve(float* x) const;

  /// The rows and columns `rows` of A^-1.
  MatrixXd inverse_block(const VectorXi& rows) const;

 private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};

}  // namespace phiz
