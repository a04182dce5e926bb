// SPDX-License-Identifier: GPL-3.0-or-later
#undef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_RVV)  // the kernel keeps vectors in arrays
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "phiz/face/blend_kernel.cpp"
#include "phiz/face/blend_kernel.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace phiz {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

void BlendBlock(const std::int16_t* entries, const int* shape, std::ptrdiff_t count, const float* scaled_weights,
                float* target, float* stretch, float* goal) {
  const hn::CappedTag<float, blend_width> d;
  const hn::RebindToSigned<decltype(d)> d_int;
  const hn::Rebind<std::int16_t, decltype(d)> d_short;
  constexpr auto width = static_cast<std::size_t>(blend_width);
  const auto one = hn::Set(d, 1.0F);
  for (std::size_t l = 0; l < width; l += hn::Lanes(d)) {
    hn::Vec<decltype(d)> v[blend_values];
    for (auto& part : v) part = hn::Zero(d);
    for (std::ptrdiff_t e = 0; e < count; ++e) {
      const float* w = scaled_weights + shape[e] * blend_values;
      if (std::all_of(w, w + blend_values, [](float value) { return value == 0; })) continue;
      const std::int16_t* entry = entries + e * blend_values * blend_width + l;
      for (std::size_t k = 0; k < blend_values; ++k) {
        const auto value = hn::ConvertTo(d, hn::PromoteTo(d_int, hn::Load(d_short, entry + k * width)));
        v[k] = hn::MulAdd(hn::Set(d, w[k]), value, v[k]);
      }
    }
    // Quaternion of an eighth of the turn by series, normalised, then squared twice.
    const auto eighth = hn::Set(d, 0.125F);
    const auto qx = hn::Mul(eighth, v[0]), qy = hn::Mul(eighth, v[1]), qz = hn::Mul(eighth, v[2]);
    const auto h2 = hn::MulAdd(qx, qx, hn::MulAdd(qy, qy, hn::Mul(qz, qz)));
    constexpr float cosine[] = {1, -1.0F / 2, 1.0F / 24, -1.0F / 720, 1.0F / 40320, -1.0F / 3628800};
    constexpr float sine[] = {1, -1.0F / 6, 1.0F / 120, -1.0F / 5040, 1.0F / 362880, -1.0F / 39916800};
    auto c = hn::Set(d, cosine[5]), s = hn::Set(d, sine[5]);
    for (int k = 4; k >= 0; --k) {
      c = hn::MulAdd(c, h2, hn::Set(d, cosine[k]));
      s = hn::MulAdd(s, h2, hn::Set(d, sine[k]));
    }
    auto x = hn::Mul(s, qx), y = hn::Mul(s, qy), z = hn::Mul(s, qz), w = c;
    const auto length2 = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::MulAdd(z, z, hn::Mul(w, w))));
    const auto scale = hn::Div(one, hn::Sqrt(length2));
    x = hn::Mul(x, scale);
    y = hn::Mul(y, scale);
    z = hn::Mul(z, scale);
    w = hn::Mul(w, scale);
    for (int twice = 0; twice < 2; ++twice) {
      const auto doubled = hn::Add(w, w);
      const auto v2 = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
      w = hn::MulSub(w, w, v2);
      x = hn::Mul(doubled, x);
      y = hn::Mul(doubled, y);
      z = hn::Mul(doubled, z);
    }
    const auto two = hn::Set(d, 2.0F);
    const auto xx = hn::Mul(x, x), yy = hn::Mul(y, y), zz = hn::Mul(z, z);
    const auto xy = hn::Mul(x, y), xz = hn::Mul(x, z), yz = hn::Mul(y, z);
    const auto wx = hn::Mul(w, x), wy = hn::Mul(w, y), wz = hn::Mul(w, z);
    const hn::Vec<decltype(d)> R[9] = {hn::NegMulAdd(two, hn::Add(yy, zz), one),
                                       hn::Mul(two, hn::Add(xy, wz)),
                                       hn::Mul(two, hn::Sub(xz, wy)),
                                       hn::Mul(two, hn::Sub(xy, wz)),
                                       hn::NegMulAdd(two, hn::Add(xx, zz), one),
                                       hn::Mul(two, hn::Add(yz, wx)),
                                       hn::Mul(two, hn::Add(xz, wy)),
                                       hn::Mul(two, hn::Sub(yz, wx)),
                                       hn::NegMulAdd(two, hn::Add(xx, yy), one)};
    const hn::Vec<decltype(d)> S[6] = {hn::Add(v[3], one), hn::Add(v[4], one), hn::Add(v[5], one), v[6], v[7], v[8]};
    constexpr int at[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i)
        hn::Store(hn::MulAdd(R[6 + i], S[at[2][j]], hn::MulAdd(R[3 + i], S[at[1][j]], hn::Mul(R[i], S[at[0][j]]))), d,
                  target + static_cast<std::size_t>(3 * j + i) * width + l);
    for (std::size_t k = 0; k < 6; ++k) hn::Store(S[k], d, stretch + k * width + l);
    // exp within the bounds that a goal may have.
    const auto bound = hn::Set(d, 0.25F);
    const auto g = hn::Max(hn::Neg(bound), hn::Min(bound, v[9]));
    auto power = one;
    for (int k = 6; k >= 1; --k) power = hn::MulAdd(hn::Mul(power, g), hn::Set(d, 1.0F / static_cast<float>(k)), one);
    hn::Store(power, d, goal + l);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace phiz
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace phiz {

HWY_EXPORT(BlendBlock);

void blend_block(const std::int16_t* entries, const int* shape, std::ptrdiff_t count, const float* scaled_weights,
                 float* target, float* stretch, float* goal) {
  HWY_DYNAMIC_DISPATCH(BlendBlock)(entries, shape, count, scaled_weights, target, stretch, goal);
}

}  // namespace phiz
#endif
