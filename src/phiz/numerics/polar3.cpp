// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/numerics/polar3.h"

#undef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_RVV)  // the kernels keep vectors in arrays
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "phiz/numerics/polar3.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <cstddef>

#include "phiz/numerics/polar3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace phiz {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<double, 8>;
constexpr D d;

/// Applies a lane kernel to matrices [begin, end) of arrays with `stride` doubles from entry to entry. The last,
/// partial group of lanes is filled up with identities.
template <class Kernel>
void ForLanes(const double* A, double* P, std::ptrdiff_t stride, std::ptrdiff_t begin, std::ptrdiff_t end,
              const Kernel& kernel) {
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  hn::Vec<D> in[9], out[9];
  std::ptrdiff_t i = begin;
  for (; i + lanes <= end; i += lanes) {
    for (int k = 0; k < 9; ++k) in[k] = hn::LoadU(d, A + k * stride + i);
    kernel(in, out);
    for (int k = 0; k < 9; ++k) hn::StoreU(out[k], d, P + k * stride + i);
  }
  if (i == end) return;
  HWY_ALIGN double rest[8];
  for (int k = 0; k < 9; ++k) {
    for (std::ptrdiff_t l = 0; l < lanes; ++l) rest[l] = i + l < end ? A[k * stride + i + l] : (k % 4 == 0 ? 1.0 : 0.0);
    in[k] = hn::Load(d, rest);
  }
  kernel(in, out);
  for (int k = 0; k < 9; ++k) {
    hn::Store(out[k], d, rest);
    for (std::ptrdiff_t l = 0; i + l < end; ++l) P[k * stride + i + l] = rest[l];
  }
}

void Rotations(const double* A, double* P, std::ptrdiff_t stride, std::ptrdiff_t begin, std::ptrdiff_t end) {
  ForLanes(A, P, stride, begin, end, [](const hn::Vec<D>* in, hn::Vec<D>* out) { ClosestRotation3(d, in, out); });
}

void Unimodulars(const double* A, double* P, std::ptrdiff_t stride, std::ptrdiff_t begin, std::ptrdiff_t end) {
  ForLanes(A, P, stride, begin, end, [](const hn::Vec<D>* in, hn::Vec<D>* out) { ClosestUnimodular3(d, in, out); });
}

}  // namespace HWY_NAMESPACE
}  // namespace phiz
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <string>

#include "phiz/core/error.h"
#include "phiz/core/parallel.h"

namespace phiz {

HWY_EXPORT(Rotations);
HWY_EXPORT(Unimodulars);

namespace {

constexpr std::ptrdiff_t grain = 4096;  // matrices per task, a multiple of every vector length

void require_finite(const Matrices3& A) {
  if (A.allFinite()) return;
  for (Eigen::Index i = 0; i < A.rows(); ++i)
    if (!A.row(i).allFinite()) fail("matrix " + std::to_string(i) + " to be projected is not finite");
}

}  // namespace

void closest_rotations(const Matrices3& A, Matrices3& R) {
  require_finite(A);
  R.resize(A.rows(), 9);
  parallel_chunks(A.rows(), grain, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    HWY_DYNAMIC_DISPATCH(Rotations)(A.data(), R.data(), A.rows(), begin, end);
  });
}

void closest_unimodulars(const Matrices3& A, Matrices3& P) {
  require_finite(A);
  P.resize(A.rows(), 9);
  parallel_chunks(A.rows(), grain, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    HWY_DYNAMIC_DISPATCH(Unimodulars)(A.data(), P.data(), A.rows(), begin, end);
  });
}

}  // namespace phiz
#endif
