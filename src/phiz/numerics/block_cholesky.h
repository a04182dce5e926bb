// SPDX-License-Identifier: GPL-3.0-or-later
/// Multifrontal Cholesky factorisation of symmetric matrices of 3x3 blocks, one per pair of neighbouring vertices, in
/// single precision. For iterations that correct its error: a solve is right to about a millionth, times the condition
/// of the matrix at worst; to about a hundredth where it reads a rounded factor.
#pragma once

#include <memory>
#include <vector>

#include "phiz/geometry/mesh.h"

namespace phiz {

/// The lower triangle by columns of blocks. Rows of a column ascend and start with the diagonal; entry (i, k) of block
/// b is value[9 b + 3 k + i].
struct BlockMatrix {
  std::vector<int> start;  ///< of each column, and the end
  std::vector<int> row;
  std::vector<float> value;

  int columns() const { return static_cast<int>(start.size()) - 1; }
};

/// The blocks that tets couple: of vertices `row_of[v]`, those below 0 left out; zeros. `size`: number of columns.
BlockMatrix block_pattern(const MatrixX4i& tets, const VectorXi& row_of, int size);

/// Order of elimination with little fill (METIS nested dissection, postordered): entry i is the vertex that is
/// eliminated as number i.
VectorXi elimination_order(const BlockMatrix& pattern);

/// A sparse row of 3 columns() entries: up to four vertices with three values each.
struct SparseRow {
  int count = 0;
  int column[4] = {-1, -1, -1, -1};
  Eigen::Vector3f value[4];
};

/// L^-1 C^T for up to 16 sparse rows C, where it is not zero: in the nodes of the elimination tree from the rows'
/// vertices up to the root.
struct SolvedRows {
  static constexpr int most = 16;
  std::vector<int> nodes;     ///< ascending
  std::vector<int> first;     ///< scalar column that each of these starts with
  std::vector<int> start;     ///< into `values` / 16, per node and the end
  std::vector<float> values;  ///< 16 per column, of which the first ones belong to the rows

  /// C A^-1 D^T: 16 x 16.
  Eigen::Matrix<float, most, most> gram(const SolvedRows& other) const;
  /// (L^-1 C^T)^T v, v: 3 columns() floats.
  Eigen::Matrix<float, most, 1> products(const float* v) const;
  /// v <- v + L^-1 C^T w.
  void add(const Eigen::Matrix<float, most, 1>& w, float* v) const;
};

/// What forward() and backward() read: the factor, or a copy of it that is rounded to 16 bits (8 of them of the
/// mantissa), which takes half of the memory traffic that bounds their speed.
enum class FactorStorage { single, rounded };

class BlockCholesky {
 public:
  /// Analyses the pattern of a matrix whose columns are in an elimination_order() already.
  explicit BlockCholesky(const BlockMatrix& pattern, FactorStorage storage = FactorStorage::single);
  ~BlockCholesky();
  BlockCholesky(BlockCholesky&&) noexcept;
  BlockCholesky& operator=(BlockCholesky&&) noexcept;
  /// Another one for the same pattern, not factorised; cheap.
  BlockCholesky twin() const;

  /// Factorises; `parallel`: on all threads, with the same bits. Where A is not positive definite, the pivots that tell
  /// so count as their absolute values: L L^T is positive definite and differs from A by a matrix of a rank that is
  /// returned, the number of negative eigenvalues of A. Returns -1, and leaves no factor, if A is not finite or a
  /// diagonal entry of it not positive.
  int factorise(const BlockMatrix& A, bool parallel = true);

  /// With A = L L^T: x <- L^-1 x and x <- L^-T x, 3 columns() floats. `sides` of them (1, 2 or 4), side_stride() apart,
  /// cost little more than one. The same bits for any number of threads. Not to be called from two threads at once on
  /// one object.
  void forward(float* x, int sides = 1) const;
  void backward(float* x, int sides = 1) const;
  void solve(float* x, int sides = 1) const;

  /// With the factor itself. Rows past the last given one are zero. May be called from several threads at once.
  SolvedRows forward_rows(const std::vector<SparseRow>& rows) const;

  int columns() const;
  std::ptrdiff_t side_stride() const;     ///< 3 columns() rounded up to a multiple of 16
  std::ptrdiff_t factor_entries() const;  ///< floats that a solve reads twice
  double flops() const;                   ///< multiplications and additions of a factorisation

 private:
  struct Plan;
  struct Values;
  explicit BlockCholesky(std::shared_ptr<const Plan> plan);
  std::shared_ptr<const Plan> plan_;
  std::unique_ptr<Values> values_;
};

}  // namespace phiz
