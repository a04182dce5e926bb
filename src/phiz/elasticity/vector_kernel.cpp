// SPDX-License-Identifier: GPL-3.0-or-later
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "phiz/elasticity/vector_kernel.cpp"
#include "phiz/elasticity/vector_kernel.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace phiz {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, 16>;
constexpr D d;

/// The lanes are summed in a tree over 16 entries whatever their number is, so that all machines agree but for fused
/// operations. Sizes are multiples of 16.
double Dot(const float* a, const float* b, std::ptrdiff_t size) {
  HWY_ALIGN float lanes[16] = {};
  for (std::size_t l = 0; l < 16; l += hn::Lanes(d)) {
    auto sum = hn::Zero(d), second = hn::Zero(d);
    std::ptrdiff_t i = 0;
    for (; i + 32 <= size; i += 32) {
      const std::size_t at = static_cast<std::size_t>(i) + l;
      sum = hn::MulAdd(hn::Load(d, a + at), hn::Load(d, b + at), sum);
      second = hn::MulAdd(hn::Load(d, a + at + 16), hn::Load(d, b + at + 16), second);
    }
    for (; i < size; i += 16) {
      const std::size_t at = static_cast<std::size_t>(i) + l;
      sum = hn::MulAdd(hn::Load(d, a + at), hn::Load(d, b + at), sum);
    }
    hn::Store(hn::Add(sum, second), d, lanes + l);
  }
  double total = 0;
  for (const float lane : lanes) total += static_cast<double>(lane);
  return total;
}

void Combine(const float* const* columns, std::ptrdiff_t count, const float* weights, float* out, std::ptrdiff_t begin,
             std::ptrdiff_t end) {
  for (std::ptrdiff_t i = begin; i < end; i += static_cast<std::ptrdiff_t>(hn::Lanes(d))) {
    auto sum = hn::Zero(d);
    for (std::ptrdiff_t k = 0; k < count; ++k)
      sum = hn::MulAdd(hn::Set(d, weights[k]), hn::Load(d, columns[k] + i), sum);
    hn::Store(sum, d, out + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace phiz
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <algorithm>

#include "phiz/core/parallel.h"

namespace phiz {

HWY_EXPORT(Dot);
HWY_EXPORT(Combine);

namespace {

constexpr std::ptrdiff_t grain = 4096;

std::ptrdiff_t padded(std::ptrdiff_t size) {
  return (size + 15) / 16 * 16;
}

}  // namespace

FloatVector float_vector(std::ptrdiff_t size) {
  const std::ptrdiff_t count = padded(size) + 16;
  FloatVector v = hwy::AllocateAligned<float>(static_cast<std::size_t>(count));
  std::fill_n(v.get(), count, 0.0F);
  return v;
}

Eigen::VectorXd dots(const std::vector<const float*>& left, const float* right, std::ptrdiff_t size) {
  const auto count = static_cast<Eigen::Index>(left.size());
  size = padded(size);
  Eigen::MatrixXd parts(count, (size + grain - 1) / grain);
  parallel_chunks(size, grain, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (Eigen::Index k = 0; k < count; ++k)
      parts(k, begin / grain) =
          HWY_DYNAMIC_DISPATCH(Dot)(left[static_cast<std::size_t>(k)] + begin, right + begin, end - begin);
  });
  return parts.rowwise().sum();
}

double dot(const float* left, const float* right, std::ptrdiff_t size) {
  return dots({left}, right, size)[0];
}

void combine(const std::vector<const float*>& columns, const Eigen::VectorXf& weights, float* out,
             std::ptrdiff_t size) {
  parallel_chunks(padded(size), grain, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    HWY_DYNAMIC_DISPATCH(Combine)
    (columns.data(), static_cast<std::ptrdiff_t>(columns.size()), weights.data(), out, begin, end);
  });
}

}  // namespace phiz
#endif
