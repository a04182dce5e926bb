// SPDX-License-Identifier: GPL-3.0-or-later
#undef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "phiz/elasticity/triangular_kernel.cpp"
#include "phiz/elasticity/triangular_kernel.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace phiz {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<double, 4>;
constexpr D d;

void DenseMultiply(const double* A, std::ptrdiff_t rows, std::ptrdiff_t cols, const double* x, double* y) {
  for (std::size_t l = 0; l < 4; l += hn::Lanes(d))
    for (std::ptrdiff_t i = 0; i < rows; i += 4) {
      const double* a = A + i * cols;
      auto s0 = hn::Zero(d), s1 = s0, s2 = s0, s3 = s0;
      for (std::ptrdiff_t j = 0; j < cols; ++j) {
        const auto v = hn::Load(d, x + 4 * j + l);
        s0 = hn::MulAdd(hn::Set(d, a[j]), v, s0);
        s1 = hn::MulAdd(hn::Set(d, a[cols + j]), v, s1);
        s2 = hn::MulAdd(hn::Set(d, a[2 * cols + j]), v, s2);
        s3 = hn::MulAdd(hn::Set(d, a[3 * cols + j]), v, s3);
      }
      hn::Store(s0, d, y + 4 * i + l);
      hn::Store(s1, d, y + 4 * i + 4 + l);
      hn::Store(s2, d, y + 4 * i + 8 + l);
      hn::Store(s3, d, y + 4 * i + 12 + l);
    }
}

void ScatterMultiply(const double* A, std::ptrdiff_t rows, std::ptrdiff_t cols, const double* x, const int* index,
                     double* y) {
  for (std::size_t l = 0; l < 4; l += hn::Lanes(d)) {
    std::ptrdiff_t i = 0;
    for (; i + 4 <= rows; i += 4) {
      const double* a = A + i * cols;
      double* y0 = y + 4 * index[i] + l;
      double* y1 = y + 4 * index[i + 1] + l;
      double* y2 = y + 4 * index[i + 2] + l;
      double* y3 = y + 4 * index[i + 3] + l;
      auto s0 = hn::Load(d, y0), s1 = hn::Load(d, y1), s2 = hn::Load(d, y2), s3 = hn::Load(d, y3);
      for (std::ptrdiff_t j = 0; j < cols; ++j) {
        const auto v = hn::Load(d, x + 4 * j + l);
        s0 = hn::NegMulAdd(hn::Set(d, a[j]), v, s0);
        s1 = hn::NegMulAdd(hn::Set(d, a[cols + j]), v, s1);
        s2 = hn::NegMulAdd(hn::Set(d, a[2 * cols + j]), v, s2);
        s3 = hn::NegMulAdd(hn::Set(d, a[3 * cols + j]), v, s3);
      }
      hn::Store(s0, d, y0);
      hn::Store(s1, d, y1);
      hn::Store(s2, d, y2);
      hn::Store(s3, d, y3);
    }
    for (; i < rows; ++i) {
      const double* a = A + i * cols;
      double* y0 = y + 4 * index[i] + l;
      auto s0 = hn::Load(d, y0);
      for (std::ptrdiff_t j = 0; j < cols; ++j) s0 = hn::NegMulAdd(hn::Set(d, a[j]), hn::Load(d, x + 4 * j + l), s0);
      hn::Store(s0, d, y0);
    }
  }
}

void GatherMultiply(const double* A, std::ptrdiff_t rows, std::ptrdiff_t cols, const double* x, const int* index,
                    double* y) {
  for (std::size_t l = 0; l < 4; l += hn::Lanes(d)) {
    std::ptrdiff_t i = 0;
    for (; i + 4 <= rows; i += 4) {
      const double* a = A + i * cols;
      const auto v0 = hn::Load(d, x + 4 * index[i] + l);
      const auto v1 = hn::Load(d, x + 4 * index[i + 1] + l);
      const auto v2 = hn::Load(d, x + 4 * index[i + 2] + l);
      const auto v3 = hn::Load(d, x + 4 * index[i + 3] + l);
      for (std::ptrdiff_t j = 0; j < cols; ++j) {
        auto s = hn::Load(d, y + 4 * j + l);
        s = hn::NegMulAdd(hn::Set(d, a[j]), v0, s);
        s = hn::NegMulAdd(hn::Set(d, a[cols + j]), v1, s);
        s = hn::NegMulAdd(hn::Set(d, a[2 * cols + j]), v2, s);
        s = hn::NegMulAdd(hn::Set(d, a[3 * cols + j]), v3, s);
        hn::Store(s, d, y + 4 * j + l);
      }
    }
    for (; i < rows; ++i) {
      const double* a = A + i * cols;
      const auto v0 = hn::Load(d, x + 4 * index[i] + l);
      for (std::ptrdiff_t j = 0; j < cols; ++j)
        hn::Store(hn::NegMulAdd(hn::Set(d, a[j]), v0, hn::Load(d, y + 4 * j + l)), d, y + 4 * j + l);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace phiz
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace phiz {

HWY_EXPORT(DenseMultiply);
HWY_EXPORT(ScatterMultiply);
HWY_EXPORT(GatherMultiply);

void dense_multiply(const double* A, std::ptrdiff_t rows, std::ptrdiff_t cols, const double* x, double* y) {
  HWY_DYNAMIC_DISPATCH(DenseMultiply)(A, rows, cols, x, y);
}

void scatter_multiply(const double* A, std::ptrdiff_t rows, std::ptrdiff_t cols, const double* x, const int* index,
                      double* y) {
  HWY_DYNAMIC_DISPATCH(ScatterMultiply)(A, rows, cols, x, index, y);
}

void gather_multiply(const double* A, std::ptrdiff_t rows, std::ptrdiff_t cols, const double* x, const int* index,
                     double* y) {
  HWY_DYNAMIC_DISPATCH(GatherMultiply)(A, rows, cols, x, index, y);
}

}  // namespace phiz
#endif
