// SPDX-License-Identifier: GPL-3.0-or-later
#undef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_RVV)  // the kernel keeps vectors in arrays
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "phiz/elasticity/panel_kernel.cpp"
#include "phiz/elasticity/panel_kernel.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace phiz {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// `groups` groups of `width` rows that lie `stride` floats apart.
template <std::size_t width, int groups>
HWY_INLINE void MultiplyGroups(const float* P, std::ptrdiff_t stride, std::ptrdiff_t columns, const float* x,
                               float* y) {
  const hn::CappedTag<float, width> d;
  for (std::size_t l = 0; l < width; l += hn::Lanes(d)) {
    hn::Vec<decltype(d)> sum[groups][3];
    for (auto& group : sum)
      for (auto& part : group) part = hn::Zero(d);
    for (std::ptrdiff_t j = 0; j < columns; ++j) {
      const auto x0 = hn::Set(d, x[4 * j]), x1 = hn::Set(d, x[4 * j + 1]), x2 = hn::Set(d, x[4 * j + 2]);
      for (int g = 0; g < groups; ++g) {
        const auto a = hn::Load(d, P + g * stride + j * static_cast<std::ptrdiff_t>(width) + l);
        sum[g][0] = hn::MulAdd(a, x0, sum[g][0]);
        sum[g][1] = hn::MulAdd(a, x1, sum[g][1]);
        sum[g][2] = hn::MulAdd(a, x2, sum[g][2]);
      }
    }
    for (int g = 0; g < groups; ++g)
      hn::StoreInterleaved4(sum[g][0], sum[g][1], sum[g][2], hn::Zero(d), d,
                            y + 4 * (static_cast<std::size_t>(g) * width + l));
  }
}

void PanelMultiply(const float* P, std::ptrdiff_t rows, std::ptrdiff_t columns, const float* x, float* y) {
  constexpr auto width = static_cast<std::size_t>(panel_group);
  const std::ptrdiff_t stride = panel_group * columns;
  std::ptrdiff_t row = 0;
  for (; rows - row > panel_group + panel_group / 2; row += 2 * panel_group)
    MultiplyGroups<width, 2>(P + row * columns, stride, columns, x, y + 4 * row);
  for (; rows - row > panel_group / 2; row += panel_group)
    MultiplyGroups<width, 1>(P + row * columns, stride, columns, x, y + 4 * row);
  if (row < rows) MultiplyGroups<width / 2, 1>(P + row * columns, stride, columns, x, y + 4 * row);
}

}  // namespace HWY_NAMESPACE
}  // namespace phiz
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace phiz {

HWY_EXPORT(PanelMultiply);

void panel_multiply(const float* P, std::ptrdiff_t rows, std::ptrdiff_t columns, const float* x, float* y) {
  HWY_DYNAMIC_DISPATCH(PanelMultiply)(P, rows, columns, x, y);
}

}  // namespace phiz
#endif
