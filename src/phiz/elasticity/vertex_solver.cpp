// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/vertex_solver.h"

#include <cholmod.h>

#include <Eigen/Core>
#include <algorithm>
#include <numeric>
#include <vector>

#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/elasticity/panel_kernel.h"
#include "phiz/elasticity/vector_kernel.h"
#include "phiz/numerics/block_cholesky.h"

namespace phiz {

namespace {

/// A CHOLMOD workspace.
struct Cholmod {
  Cholmod() { cholmod_start(&common); }
  ~Cholmod() { cholmod_finish(&common); }
  Cholmod(const Cholmod&) = delete;
  Cholmod& operator=(const Cholmod&) = delete;
  cholmod_common common;
};

/// Lower triangle (by columns) of a symmetric row-major matrix, for CHOLMOD; `sparse` points into the arrays.
struct LowerTriangle {
  explicit LowerTriangle(const SparseMatrixd& A) : start(static_cast<std::size_t>(A.rows()) + 1, 0) {
    for (int i = 0; i < A.rows(); ++i) {
      for (SparseMatrixd::InnerIterator it(A, i); it; ++it)
        if (it.col() >= i) {
          row.push_back(static_cast<int>(it.col()));
          value.push_back(it.value());
        }
      start[static_cast<std::size_t>(i) + 1] = static_cast<int>(row.size());
    }
    sparse = {};
    sparse.nrow = sparse.ncol = static_cast<std::size_t>(A.rows());
    sparse.nzmax = row.size();
    sparse.p = start.data();
    sparse.i = row.data();
    sparse.x = value.data();
    sparse.stype = -1;
    sparse.itype = CHOLMOD_INT;
    sparse.xtype = CHOLMOD_REAL;
    sparse.dtype = CHOLMOD_DOUBLE;
    sparse.sorted = 1;
    sparse.packed = 1;
  }
  std::vector<int> start, row;
  std::vector<double> value;
  cholmod_sparse sparse;
};

/// Subtrees of the elimination tree that are solved side by side; a constant, so that sums do not depend on the
/// machine.
constexpr int bins = 4;

}  // namespace

VectorXi elimination_order(const SparseMatrixd& pattern) {
  const LowerTriangle lower(pattern);
  return elimination_order(BlockMatrix{lower.start, lower.row, {}});
}

struct VertexSolver::Factor {
  /// Of the block column [L1; L2] of the factor, the panel Q = [L1^-1; L2 L1^-1] does both passes. Forward: [y; z] = Q
  /// x1, x1 <- y, x2 <- x2 - z. Backward: x1 <- Q^T [x1; -x2].
  struct Supernode {
    int first = 0, columns = 0;
    int rows = 0;                              ///< below the diagonal block
    int inside = 0;                            ///< of these, the first ones, which belong to the same bin
    std::ptrdiff_t index = 0;                  ///< into row_index
    std::ptrdiff_t forward = 0, backward = 0;  ///< into values: Q, Q^T
  };
  std::ptrdiff_t n = 0;
  std::vector<Supernode> supernodes;
  std::vector<int> row_index;  ///< row of x, or of the bin's buffer of top rows
  FloatVector values;
  std::ptrdiff_t value_count = 0;
  int tallest = 0;                     ///< panel, rows
  std::vector<int> bin_members[bins];  ///< supernodes of each bin, ascending
  std::vector<int> top;                ///< supernodes above all bins, ascending
  std::vector<int> top_rows;
  FloatVector outside[bins];                  ///< top rows x 4
  FloatVector scratch[bins], gathered[bins];  ///< four floats per row of the tallest panel

  void forward(const Supernode& s, int bin, float* x, float* top_part) const {
    const std::ptrdiff_t columns = s.columns;
    float* mine = x + 4 * static_cast<std::ptrdiff_t>(s.first);
    float* product = scratch[bin].get();
    panel_multiply(values.get() + s.forward, columns + s.rows, columns, mine, product);
    std::copy_n(product, 4 * columns, mine);
    for_rows(s, [&](int r, std::ptrdiff_t at) {
      float* target = (r < s.inside ? x : top_part) + 4 * at;
      for (std::ptrdiff_t k = 0; k < 4; ++k) target[k] -= product[4 * (columns + r) + k];
    });
  }

  void backward(const Supernode& s, int bin, float* x, const float* top_part) const {
    const std::ptrdiff_t columns = s.columns;
    float* mine = x + 4 * static_cast<std::ptrdiff_t>(s.first);
    float* sources = gathered[bin].get();
    std::copy_n(mine, 4 * columns, sources);
    for_rows(s, [&](int r, std::ptrdiff_t at) {
      const float* source = (r < s.inside ? x : top_part) + 4 * at;
      for (std::ptrdiff_t k = 0; k < 4; ++k) sources[4 * (columns + r) + k] = -source[k];
    });
    panel_multiply(values.get() + s.backward, columns, columns + s.rows, sources, scratch[bin].get());
    std::copy_n(scratch[bin].get(), 4 * columns, mine);
  }

  template <class Action>
  void for_rows(const Supernode& s, Action&& action) const {
    const int* index = row_index.data() + s.index;
    for (int r = 0; r < s.rows; ++r) action(r, static_cast<std::ptrdiff_t>(index[r]));
  }

  void take(const cholmod_factor& L);
  void divide(const std::vector<int>& parent);
};

/// Copies CHOLMOD's supernodes into panels.
void VertexSolver::Factor::take(const cholmod_factor& L) {
  n = static_cast<std::ptrdiff_t>(L.n);
  const auto* super = static_cast<const int*>(L.super);
  const auto* pi = static_cast<const int*>(L.pi);
  const auto* px = static_cast<const int*>(L.px);
  const auto* rows = static_cast<const int*>(L.s);
  const auto* x = static_cast<const double*>(L.x);
  supernodes.resize(L.nsuper);
  const auto aligned = [](std::ptrdiff_t size) { return (size + 15) / 16 * 16; };
  for (std::size_t k = 0; k < L.nsuper; ++k) {
    Supernode& s = supernodes[k];
    s.first = super[k];
    s.columns = super[k + 1] - super[k];
    s.rows = pi[k + 1] - pi[k] - s.columns;
    s.index = static_cast<std::ptrdiff_t>(row_index.size());
    row_index.insert(row_index.end(), rows + pi[k] + s.columns, rows + pi[k + 1]);
    s.forward = value_count;
    s.backward = s.forward + aligned(panel_size(s.columns + s.rows, s.columns));
    value_count = s.backward + aligned(panel_size(s.columns, s.columns + s.rows));
    tallest = std::max(tallest, s.columns + s.rows);
  }
  values = float_vector(value_count);
  for (std::size_t k = 0; k < L.nsuper; ++k) {
    const Supernode& s = supernodes[k];
    const std::ptrdiff_t columns = s.columns, height = s.columns + s.rows;
    const Eigen::Map<const MatrixXd> dense(x + px[k], height, columns);
    MatrixXd Q(height, columns);
    Q.topRows(columns) =
        dense.topRows(columns).triangularView<Eigen::Lower>().solve(MatrixXd::Identity(columns, columns));
    Q.bottomRows(s.rows) = dense.bottomRows(s.rows) * Q.topRows(columns);
    for (std::ptrdiff_t j = 0; j < columns; ++j)
      for (std::ptrdiff_t i = 0; i < height; ++i) {
        const auto value = static_cast<float>(Q(i, j));
        values[static_cast<std::size_t>(s.forward + panel_at(height, columns, i, j))] = value;
        values[static_cast<std::size_t>(s.backward + panel_at(columns, height, j, i))] = value;
      }
  }
}

/// Cuts the tree into balanced bins of subtrees and the top above them, and redirects the rows of the top to the
/// buffers.
void VertexSolver::Factor::divide(const std::vector<int>& parent) {
  const int count = static_cast<int>(supernodes.size());
  std::vector<double> work(supernodes.size(), 0.0);
  std::vector<std::vector<int>> children(supernodes.size());
  std::vector<int> roots;
  double total = 0;
  for (int k = 0; k < count; ++k) {
    const auto u = static_cast<std::size_t>(k);
    const double own = static_cast<double>(supernodes[u].columns) * (supernodes[u].columns + supernodes[u].rows);
    total += own;
    work[u] += own;
    const int p = parent[u];
    if (p < 0) {
      roots.push_back(k);
      continue;
    }
    work[static_cast<std::size_t>(p)] += work[u];
    children[static_cast<std::size_t>(p)].push_back(k);
  }
  // Split the largest subtree until none holds more than a share of the work.
  std::vector<int> subtrees = roots;
  std::vector<char> is_top(supernodes.size(), 0);
  const auto heavier = [&](int a, int b) {
    return work[static_cast<std::size_t>(a)] < work[static_cast<std::size_t>(b)];
  };
  while (!subtrees.empty()) {
    const auto largest_tree = std::max_element(subtrees.begin(), subtrees.end(), heavier);
    const auto u = static_cast<std::size_t>(*largest_tree);
    if (work[u] < 0.12 * total || children[u].empty()) break;
    is_top[u] = 1;
    subtrees.erase(largest_tree);
    subtrees.insert(subtrees.end(), children[u].begin(), children[u].end());
  }
  std::sort(subtrees.begin(), subtrees.end(), [&](int a, int b) { return heavier(b, a) || (!heavier(a, b) && a < b); });
  std::vector<int> bin_of(supernodes.size(), -1);
  double load[bins] = {};
  for (const int root : subtrees) {
    const auto lightest = static_cast<int>(std::min_element(load, load + bins) - load);
    load[lightest] += work[static_cast<std::size_t>(root)];
    bin_of[static_cast<std::size_t>(root)] = lightest;
  }
  for (int k = count - 1; k >= 0; --k) {
    const auto u = static_cast<std::size_t>(k);
    if (bin_of[u] < 0 && !is_top[u]) bin_of[u] = bin_of[static_cast<std::size_t>(parent[u])];
  }
  std::vector<int> top_id(static_cast<std::size_t>(n), -1);
  for (int k = 0; k < count; ++k) {
    const auto u = static_cast<std::size_t>(k);
    if (!is_top[u]) {
      bin_members[bin_of[u]].push_back(k);
      continue;
    }
    top.push_back(k);
    for (int c = 0; c < supernodes[u].columns; ++c) {
      const int row = supernodes[u].first + c;
      top_id[static_cast<std::size_t>(row)] = static_cast<int>(top_rows.size());
      top_rows.push_back(row);
    }
  }
  for (int k = 0; k < count; ++k) {
    Supernode& s = supernodes[static_cast<std::size_t>(k)];
    s.inside = s.rows;
    if (is_top[static_cast<std::size_t>(k)]) continue;
    int* index = row_index.data() + s.index;
    s.inside = static_cast<int>(
        std::find_if(index, index + s.rows, [&](int r) { return top_id[static_cast<std::size_t>(r)] >= 0; }) - index);
    for (int r = s.inside; r < s.rows; ++r) index[r] = top_id[static_cast<std::size_t>(index[r])];
  }
  for (int bin = 0; bin < bins; ++bin) {
    outside[bin] = float_vector(4 * static_cast<std::ptrdiff_t>(top_rows.size()));
    scratch[bin] = float_vector(4 * (tallest + panel_group));
    gathered[bin] = float_vector(4 * (tallest + panel_group));
  }
}

VertexSolver::VertexSolver(const SparseMatrixd& A) : factor_(std::make_unique<Factor>()) {
  Cholmod c;
  c.common.nmethods = 1;
  c.common.method[0].ordering = CHOLMOD_NATURAL;
  c.common.postorder = 0;
  c.common.supernodal = CHOLMOD_SUPERNODAL;
  c.common.print = 0;
  LowerTriangle lower(A);
  cholmod_factor* L = cholmod_analyze(&lower.sparse, &c.common);
  if (L != nullptr) cholmod_factorize(&lower.sparse, L, &c.common);
  const bool good = L != nullptr && c.common.status == CHOLMOD_OK && L->minor == L->n && L->is_super;
  if (good) {
    factor_->take(*L);
    // The parent of a supernode holds the first row below its diagonal block.
    std::vector<int> supernode_of(static_cast<std::size_t>(factor_->n));
    for (std::size_t k = 0; k < factor_->supernodes.size(); ++k)
      std::fill_n(supernode_of.begin() + factor_->supernodes[k].first, factor_->supernodes[k].columns,
                  static_cast<int>(k));
    std::vector<int> parent;
    for (const Factor::Supernode& s : factor_->supernodes)
      parent.push_back(
          s.rows > 0 ? supernode_of[static_cast<std::size_t>(factor_->row_index[static_cast<std::size_t>(s.index)])]
                     : -1);
    factor_->divide(parent);
  }
  cholmod_free_factor(&L, &c.common);
  if (!good)
    fail("the elastic system is not positive definite",
         "every connected piece of flesh must touch a bone or carry an attachment");
}

VertexSolver::~VertexSolver() = default;
VertexSolver::VertexSolver(VertexSolver&&) noexcept = default;
VertexSolver& VertexSolver::operator=(VertexSolver&&) noexcept = default;

std::ptrdiff_t VertexSolver::rows() const {
  return factor_->n;
}
std::ptrdiff_t VertexSolver::factor_entries() const {
  return factor_->value_count;
}

void VertexSolver::solve(float* x) const {
  const Factor& f = *factor_;
  const auto supernode = [&f](int k) -> const Factor::Supernode& { return f.supernodes[static_cast<std::size_t>(k)]; };
  parallel_chunks(bins, 1, [&](std::ptrdiff_t chunk, std::ptrdiff_t) {
    const int bin = static_cast<int>(chunk);
    float* outside = f.outside[bin].get();
    std::fill_n(outside, 4 * f.top_rows.size(), 0.0F);
    for (const int k : f.bin_members[bin]) f.forward(supernode(k), bin, x, outside);
  });
  for (const FloatVector& outside : f.outside)
    for (std::size_t r = 0; r < f.top_rows.size(); ++r)
      for (std::size_t k = 0; k < 4; ++k) x[4 * static_cast<std::size_t>(f.top_rows[r]) + k] += outside[4 * r + k];
  for (const int k : f.top) f.forward(supernode(k), 0, x, x);
  for (auto k = f.top.rbegin(); k != f.top.rend(); ++k) f.backward(supernode(*k), 0, x, x);
  float* solved = f.outside[0].get();  // now holds the solution of the top rows for all bins
  for (std::size_t r = 0; r < f.top_rows.size(); ++r)
    std::copy_n(x + 4 * static_cast<std::size_t>(f.top_rows[r]), 4, solved + 4 * r);
  parallel_chunks(bins, 1, [&](std::ptrdiff_t chunk, std::ptrdiff_t) {
    const int bin = static_cast<int>(chunk);
    for (auto k = f.bin_members[bin].rbegin(); k != f.bin_members[bin].rend(); ++k)
      f.backward(supernode(*k), bin, x, solved);
  });
}

MatrixXd VertexSolver::inverse_block(const VectorXi& rows) const {
  const Eigen::Index count = rows.size();
  MatrixXd block(count, count);
  const FloatVector x = float_vector(4 * factor_->n);
  for (Eigen::Index first = 0; first < count; first += 3) {
    std::fill_n(x.get(), factor_->n * 4, 0.0F);
    const Eigen::Index batch = std::min<Eigen::Index>(3, count - first);
    for (Eigen::Index k = 0; k < batch; ++k) x[static_cast<std::size_t>(4 * rows[first + k] + k)] = 1;
    solve(x.get());
    for (Eigen::Index i = 0; i < count; ++i)
      for (Eigen::Index k = 0; k < batch; ++k)
        block(i, first + k) = static_cast<double>(x[static_cast<std::size_t>(4 * rows[i] + k)]);
  }
  return 0.5 * (block + block.transpose());
}

}  // namespace phiz
