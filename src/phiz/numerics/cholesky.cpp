// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/numerics/cholesky.h"

#include <cholmod.h>
#include <spdlog/fmt/fmt.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <mutex>
#include <vector>

#include "phiz/core/error.h"

extern "C" void openblas_set_num_threads(int count);

namespace phiz {

namespace {

/// Settings and workspace of CHOLMOD; one per thread that solves.
class Workspace {
 public:
  Workspace() {
    cholmod_start(&common_);
    common_.print = 0;
    common_.nmethods = 1;
    common_.method[0].ordering = CHOLMOD_METIS;
    common_.supernodal = CHOLMOD_SUPERNODAL;
  }
  ~Workspace() { cholmod_finish(&common_); }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;
  cholmod_common* get() { return &common_; }

 private:
  cholmod_common common_;
};

/// A symmetric matrix by rows is itself by columns; CHOLMOD reads the lower triangle only. Borrows the arrays of A.
cholmod_sparse borrow(const SparseMatrixd& A) {
  cholmod_sparse view{};
  view.nrow = view.ncol = static_cast<std::size_t>(A.rows());
  view.nzmax = static_cast<std::size_t>(A.nonZeros());
  view.p = const_cast<int*>(A.outerIndexPtr());
  view.i = const_cast<int*>(A.innerIndexPtr());
  view.x = const_cast<double*>(A.valuePtr());
  view.stype = -1;
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = 1;
  view.packed = 1;
  return view;
}

SparseMatrixd compressed(const SparseMatrixd& A) {
  SparseMatrixd copy = A;
  copy.makeCompressed();
  return copy;
}

cholmod_dense borrow(Eigen::Ref<MatrixXd> B) {
  cholmod_dense view{};
  view.nrow = static_cast<std::size_t>(B.rows());
  view.ncol = static_cast<std::size_t>(B.cols());
  view.d = static_cast<std::size_t>(B.outerStride());
  view.nzmax = view.d * view.ncol;
  view.x = B.data();
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  return view;
}

}  // namespace

struct SparseCholesky::Factor {
  Workspace workspace;
  cholmod_factor* L = nullptr;
  std::vector<int> outer, inner;  // pattern of the analysed matrix
  bool valid = false;

  ~Factor() { cholmod_free_factor(&L, workspace.get()); }

  void factorise(const SparseMatrixd& A) {
    valid = false;
    for (Eigen::Index row = 0; row < A.rows(); ++row)
      for (SparseMatrixd::InnerIterator it(A, row); it; ++it)
        if (!std::isfinite(it.value()))
          fail(fmt::format("the matrix to be factorised is not finite at row {}, column {}", row, it.col()));
    cholmod_sparse view = borrow(A);
    if (L == nullptr) {
      {
        // METIS draws from one random generator for all threads: apart, its orderings are the same every time.
        static std::mutex one_at_a_time;
        const std::lock_guard lock(one_at_a_time);
        L = cholmod_analyze(&view, workspace.get());
      }
      if (L == nullptr) fail("the analysis of a sparse matrix failed", "there may be too little memory");
      outer.assign(A.outerIndexPtr(), A.outerIndexPtr() + A.rows() + 1);
      inner.assign(A.innerIndexPtr(), A.innerIndexPtr() + A.nonZeros());
    }
    cholmod_factorize(&view, L, workspace.get());
    if (workspace.get()->status == CHOLMOD_NOT_POSDEF || L->minor < L->n)
      fail(fmt::format("a matrix that must be positive definite is not; the factorisation broke down at row {}",
                       static_cast<const int*>(L->Perm)[std::min(L->minor, L->n - 1)]),
           "look for unconstrained vertices or degenerate elements");
    if (workspace.get()->status < CHOLMOD_OK) fail("a sparse factorisation failed", "there may be too little memory");
    valid = true;
  }
};

SparseCholesky::SparseCholesky(const SparseMatrixd& A) : factor_(std::make_unique<Factor>()) {
  static std::once_flag once;
  std::call_once(once, [] { openblas_set_num_threads(1); });
  if (A.rows() != A.cols() || A.rows() == 0)
    fail(fmt::format("a {} x {} matrix cannot be factorised", A.rows(), A.cols()));
  factor_->factorise(compressed(A));
}

SparseCholesky::~SparseCholesky() = default;
SparseCholesky::SparseCholesky(SparseCholesky&&) noexcept = default;
SparseCholesky& SparseCholesky::operator=(SparseCholesky&&) noexcept = default;

void SparseCholesky::refactor(const SparseMatrixd& A) {
  const SparseMatrixd packed = compressed(A);
  const auto& outer = factor_->outer;
  const auto& inner = factor_->inner;
  if (packed.rows() != rows() || packed.cols() != rows() ||
      packed.nonZeros() != static_cast<Eigen::Index>(inner.size()) ||
      !std::equal(outer.begin(), outer.end(), packed.outerIndexPtr()) ||
      !std::equal(inner.begin(), inner.end(), packed.innerIndexPtr()))
    fail("a matrix was to be refactorised with another sparsity pattern", "construct a new factorisation");
  factor_->factorise(packed);
}

MatrixXd SparseCholesky::solve(const MatrixXd& B) const {
  MatrixXd X = B;
  solve_in_place(X);
  return X;
}

void SparseCholesky::solve_in_place(Eigen::Ref<MatrixXd> B) const {
  if (!factor_->valid) fail("a solve was asked of a failed factorisation");
  if (B.rows() != rows()) fail(fmt::format("a right-hand side has {} rows, expected {}", B.rows(), rows()));
  if (B.cols() == 0) return;
  Workspace workspace;
  cholmod_dense view = borrow(B);
  cholmod_dense* X = cholmod_solve(CHOLMOD_A, factor_->L, &view, workspace.get());
  if (X == nullptr) fail("a sparse solve failed", "there may be too little memory");
  B = Eigen::Map<const MatrixXd>(static_cast<const double*>(X->x), B.rows(), B.cols());
  cholmod_free_dense(&X, workspace.get());
}

Eigen::Index SparseCholesky::rows() const {
  return static_cast<Eigen::Index>(factor_->L->n);
}

Eigen::Index SparseCholesky::factor_entries() const {
  return static_cast<Eigen::Index>(factor_->L->is_super != 0 ? factor_->L->xsize : factor_->L->nzmax);
}

}  // namespace phiz
