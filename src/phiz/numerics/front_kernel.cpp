// SPDX-License-Identifier: GPL-3.0-or-later
#undef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_RVV)  // the kernel keeps vectors in arrays
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "phiz/numerics/front_kernel.cpp"
#include "phiz/numerics/front_kernel.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace phiz {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, 16>;
using V = hn::Vec<D>;
constexpr std::ptrdiff_t lanes = static_cast<std::ptrdiff_t>(hn::MaxLanes(D()));
constexpr std::ptrdiff_t group = front_group;
constexpr int vectors = static_cast<int>(group / lanes);  // of a group
// Tiles that fill the registers: columns, and groups of rows.
constexpr int widest = lanes == 16 ? 8 : lanes == 8 ? 4 : 2;
constexpr int highest = lanes == 16 ? 3 : 1;

/// Columns [0, W) of G groups of rows: F less the product of the first k finished columns of these rows, A, and of the
/// rows that belong to the columns, B. `stride`: floats from group to group of A.
template <int G, int W>
struct Tile {
  V x[G * vectors][W];

  HWY_INLINE void Load(const float* F, std::ptrdiff_t ld) {
    for (int c = 0; c < W; ++c)
      for (int v = 0; v < G * vectors; ++v) x[v][c] = hn::LoadU(D(), F + c * ld + v * lanes);
  }
  template <bool is_signed = false>
  HWY_INLINE void Subtract(const float* A, std::ptrdiff_t stride, const float* B, std::ptrdiff_t k,
                           const float* sign = nullptr) {
    for (std::ptrdiff_t i = 0; i < k; ++i) {
      V a[G * vectors];
      for (int g = 0; g < G; ++g)
        for (int v = 0; v < vectors; ++v) a[g * vectors + v] = hn::LoadU(D(), A + g * stride + i * group + v * lanes);
      if (is_signed)
        for (V& x_ : a) x_ = hn::Mul(x_, hn::Set(D(), sign[i]));
      for (int c = 0; c < W; ++c) {
        const V b = hn::Set(D(), B[i * group + c]);
        for (int v = 0; v < G * vectors; ++v) x[v][c] = hn::NegMulAdd(a[v], b, x[v][c]);
      }
    }
  }
  /// By the transpose of the triangle of the columns, whose first one is at B.
  template <bool is_signed = false>
  HWY_INLINE void SolveTriangle(const float* B, const float* inverse_diagonal, const float* sign = nullptr) {
    for (int c = 0; c < W; ++c) {
      for (int q = 0; q < c; ++q) {
        const V b = hn::Set(D(), is_signed ? sign[q] * B[q * group + c] : B[q * group + c]);
        for (int v = 0; v < G * vectors; ++v) x[v][c] = hn::NegMulAdd(x[v][q], b, x[v][c]);
      }
      const V inverse = hn::Set(D(), is_signed ? sign[c] * inverse_diagonal[c] : inverse_diagonal[c]);
      for (int v = 0; v < G * vectors; ++v) x[v][c] = hn::Mul(x[v][c], inverse);
    }
  }
  HWY_INLINE void StoreGroups(float* A, std::ptrdiff_t stride) const {
    for (int g = 0; g < G; ++g)
      for (int c = 0; c < W; ++c)
        for (int v = 0; v < vectors; ++v)
          hn::StoreU(x[g * vectors + v][c], D(), A + g * stride + c * group + v * lanes);
  }
  HWY_INLINE void Store(float* F, std::ptrdiff_t ld) const {
    for (int c = 0; c < W; ++c)
      for (int v = 0; v < G * vectors; ++v) hn::StoreU(x[v][c], D(), F + c * ld + v * lanes);
  }
};

/// Finishes the columns [j, j + W) in G groups of rows from A on.
template <int G, int W, bool is_signed>
HWY_INLINE void FinishGroups(const Front& f, const float* F, std::ptrdiff_t ld, std::ptrdiff_t j, float* A) {
  const std::ptrdiff_t stride = f.p * group;
  const float* B = f.L1 + j / group * stride + j % group;
  Tile<G, W> tile;
  tile.Load(F + j * ld, ld);
  tile.template Subtract<is_signed>(A, stride, B, j, f.sign);
  tile.template SolveTriangle<is_signed>(B + j * group, f.inverse_diagonal + j, f.sign + j);
  tile.StoreGroups(A + j * group, stride);
}

/// Finishes the columns [j, j + W) in `groups` groups of rows.
template <int W, bool is_signed>
HWY_INLINE void FinishStrip(const Front& f, const float* F, std::ptrdiff_t ld, std::ptrdiff_t j, float* A,
                            std::ptrdiff_t groups) {
  const std::ptrdiff_t stride = f.p * group;
  std::ptrdiff_t g = 0;
  for (; g + highest <= groups; g += highest)
    FinishGroups<highest, W, is_signed>(f, F + g * group, ld, j, A + g * stride);
  for (; g < groups; ++g) FinishGroups<1, W, is_signed>(f, F + g * group, ld, j, A + g * stride);
}

/// The group of rows that holds the diagonal of the columns [j, j + W). Returns as factor_own().
template <int W>
int FinishDiagonal(const Front& f, const float* F, std::ptrdiff_t ld, std::ptrdiff_t j, bool has_negative) {
  const std::ptrdiff_t stride = f.p * group, g = j / group, first = j % group;
  float* A = f.L1 + g * stride;
  HWY_ALIGN float x[W * group];
  Tile<1, W> tile;
  tile.Load(F + j * ld + g * group, ld);
  if (has_negative)
    tile.template Subtract<true>(A, stride, A + first, j, f.sign);
  else
    tile.Subtract(A, stride, A + first, j);
  tile.Store(x, group);
  constexpr float rounding = 1e-6F, least_negative = 1e-3F;  // of the diagonal entry
  int negative = 0;
  for (int c = 0; c < W; ++c) {
    const std::ptrdiff_t row = first + c;
    float* column = x + c * group;
    for (int q = 0; q < c; ++q) {
      const float b = f.sign[j + q] * x[q * group + row];
      for (std::ptrdiff_t i = row; i < group; ++i) column[i] -= x[q * group + i] * b;
    }
    const float whole = f.diagonal[j + c], pivot = column[row];
    if (!std::isfinite(pivot)) return -1;
    const bool is_negative = pivot < rounding * whole;
    const float inverse = 1 / std::sqrt(is_negative ? std::max(-pivot, least_negative * whole) : pivot);
    f.inverse_diagonal[j + c] = inverse;
    f.sign[j + c] = is_negative ? -1 : 1;
    negative += is_negative ? 1 : 0;
    for (std::ptrdiff_t i = 0; i <= row; ++i) column[i] = 0;
    for (std::ptrdiff_t i = row + 1; i < group; ++i) column[i] *= f.sign[j + c] * inverse;
  }
  std::copy_n(x, W * group, A + j * group);
  return negative;
}

template <int W>
HWY_INLINE bool FinishOwnStrip(const Front& f, const float* F, std::ptrdiff_t ld, std::ptrdiff_t j, int& negative) {
  const int here = FinishDiagonal<W>(f, F, ld, j, negative > 0);
  if (here < 0) return false;
  negative += here;
  const std::ptrdiff_t next = j / group + 1, groups = whole_groups(f.p) / group - next;
  float* A = f.L1 + next * f.p * group;
  if (negative > 0)
    FinishStrip<W, true>(f, F + next * group, ld, j, A, groups);
  else
    FinishStrip<W, false>(f, F + next * group, ld, j, A, groups);
  return true;
}

int FactorOwn(const Front& f, const float* F, std::ptrdiff_t ld) {
  std::ptrdiff_t j = 0;
  int negative = 0;
  for (; j + widest <= f.p; j += widest)
    if (!FinishOwnStrip<widest>(f, F, ld, j, negative)) return -1;
  if constexpr (widest >= 8)
    for (; j + 4 <= f.p; j += 4)
      if (!FinishOwnStrip<4>(f, F, ld, j, negative)) return -1;
  if constexpr (widest >= 4)
    for (; j + 2 <= f.p; j += 2)
      if (!FinishOwnStrip<2>(f, F, ld, j, negative)) return -1;
  for (; j < f.p; ++j)
    if (!FinishOwnStrip<1>(f, F, ld, j, negative)) return -1;
  return negative;
}

/// All columns of G groups of rows.
template <int G, bool is_signed>
HWY_INLINE void FinishRows(const Front& f, const float* F, std::ptrdiff_t ld, float* A) {
  std::ptrdiff_t j = 0;
  for (; j + widest <= f.p; j += widest) FinishGroups<G, widest, is_signed>(f, F, ld, j, A);
  if constexpr (widest >= 8)
    for (; j + 4 <= f.p; j += 4) FinishGroups<G, 4, is_signed>(f, F, ld, j, A);
  if constexpr (widest >= 4)
    for (; j + 2 <= f.p; j += 2) FinishGroups<G, 2, is_signed>(f, F, ld, j, A);
  for (; j < f.p; ++j) FinishGroups<G, 1, is_signed>(f, F, ld, j, A);
}

template <bool is_signed>
void FactorGroups(const Front& f, const float* F, std::ptrdiff_t ld, std::ptrdiff_t begin, std::ptrdiff_t end) {
  const float* rows = F + whole_groups(f.p);
  const std::ptrdiff_t stride = f.p * group;
  std::ptrdiff_t g = begin;
  for (; g + highest <= end; g += highest) FinishRows<highest, is_signed>(f, rows + g * group, ld, f.L2 + g * stride);
  for (; g < end; ++g) FinishRows<1, is_signed>(f, rows + g * group, ld, f.L2 + g * stride);
}

void FactorBelow(const Front& f, bool has_negative, const float* F, std::ptrdiff_t ld, std::ptrdiff_t begin,
                 std::ptrdiff_t end) {
  if (has_negative)
    FactorGroups<true>(f, F, ld, begin, end);
  else
    FactorGroups<false>(f, F, ld, begin, end);
}

template <int G, int W, bool is_signed>
HWY_INLINE void UpdateGroups(const Front& f, float* U, std::ptrdiff_t ld, std::ptrdiff_t j, std::ptrdiff_t g) {
  const std::ptrdiff_t stride = f.p * group;
  Tile<G, W> tile;
  float* at = U + j * ld + g * group;
  tile.Load(at, ld);
  tile.template Subtract<is_signed>(f.L2 + g * stride, stride, f.L2 + j / group * stride + j % group, f.p, f.sign);
  tile.Store(at, ld);
}

template <int W, bool is_signed>
HWY_INLINE void UpdateStrip(const Front& f, float* U, std::ptrdiff_t ld, std::ptrdiff_t j) {
  const std::ptrdiff_t groups = ld / group;
  std::ptrdiff_t g = j / group;
  for (; g + highest <= groups; g += highest) UpdateGroups<highest, W, is_signed>(f, U, ld, j, g);
  for (; g < groups; ++g) UpdateGroups<1, W, is_signed>(f, U, ld, j, g);
}

template <bool is_signed>
void UpdateColumns(const Front& f, float* U, std::ptrdiff_t begin, std::ptrdiff_t end) {
  const std::ptrdiff_t ld = whole_groups(f.r);
  std::ptrdiff_t j = begin;
  for (; j + widest <= end; j += widest) UpdateStrip<widest, is_signed>(f, U, ld, j);
  if constexpr (widest >= 8)
    for (; j + 4 <= end; j += 4) UpdateStrip<4, is_signed>(f, U, ld, j);
  if constexpr (widest >= 4)
    for (; j + 2 <= end; j += 2) UpdateStrip<2, is_signed>(f, U, ld, j);
  for (; j < end; ++j) UpdateStrip<1, is_signed>(f, U, ld, j);
}

void UpdateFront(const Front& f, bool has_negative, float* U, std::ptrdiff_t begin, std::ptrdiff_t end) {
  if (has_negative)
    UpdateColumns<true>(f, U, begin, end);
  else
    UpdateColumns<false>(f, U, begin, end);
}

HWY_INLINE V Entries(const float* at) {
  return hn::LoadU(D(), at);
}
/// Of a rounded factor: the upper halves of floats.
HWY_INLINE V Entries(const std::uint16_t* at) {
  const hn::Rebind<std::uint32_t, D> words;
  const hn::Rebind<std::uint16_t, D> halves;
  return hn::BitCast(D(), hn::ShiftLeft<16>(hn::PromoteTo(words, hn::LoadU(halves, at))));
}

/// The upper halves of floats, to the nearest; `count`: a multiple of 16.
void RoundEntries(const float* from, std::uint16_t* to, std::ptrdiff_t count) {
  const hn::Rebind<std::int32_t, D> words;
  const hn::Rebind<std::uint16_t, D> halves;
  const auto half_way = hn::Set(words, 0x7fff), one = hn::Set(words, 1);
  for (std::ptrdiff_t i = 0; i < count; i += lanes) {
    const auto bits = hn::BitCast(hn::Rebind<std::uint32_t, D>(), hn::LoadU(D(), from + i));
    const auto upper = hn::BitCast(words, hn::ShiftRight<16>(bits));
    const auto rounded = hn::Add(hn::BitCast(words, bits), hn::Add(half_way, hn::And(upper, one)));
    const auto out = hn::ShiftRight<16>(hn::BitCast(hn::Rebind<std::uint32_t, D>(), rounded));
    hn::StoreU(hn::DemoteTo(halves, hn::BitCast(words, out)), halves, to + i);
  }
}

/// z <- z +- (G groups of A) y; `stride` entries from group to group of A.
template <int G, int S, bool subtract, class Entry>
HWY_INLINE void MultiplyGroups(const Entry* A, std::ptrdiff_t stride, std::ptrdiff_t k, const float* y,
                               std::ptrdiff_t y_apart, float* z, std::ptrdiff_t z_apart) {
  V sum[G * vectors][S];
  for (int s = 0; s < S; ++s)
    for (int v = 0; v < G * vectors; ++v)
      sum[v][s] = subtract ? hn::LoadU(D(), z + s * z_apart + v * lanes) : hn::Zero(D());
  for (std::ptrdiff_t i = 0; i < k; ++i) {
    V b[S];
    for (int s = 0; s < S; ++s) b[s] = hn::Set(D(), y[s * y_apart + i]);
    for (int g = 0; g < G; ++g)
      for (int v = 0; v < vectors; ++v) {
        const V a = Entries(A + g * stride + i * group + v * lanes);
        for (int s = 0; s < S; ++s) {
          V& x = sum[g * vectors + v][s];
          x = subtract ? hn::NegMulAdd(a, b[s], x) : hn::MulAdd(a, b[s], x);
        }
      }
  }
  for (int s = 0; s < S; ++s)
    for (int v = 0; v < G * vectors; ++v) hn::StoreU(sum[v][s], D(), z + s * z_apart + v * lanes);
}

template <int S, class Entry>
void Forward(const Front& f, const Entry* L1, const Entry* L2, float* y, float* z) {
  const std::ptrdiff_t stride = f.p * group, own = whole_groups(f.p), below = whole_groups(f.r);
  for (std::ptrdiff_t g = 0; g * group < f.p; ++g) {
    const Entry* A = L1 + g * stride;
    const std::ptrdiff_t first = g * group;
    MultiplyGroups<1, S, true>(A, stride, first, y, own, y + first, own);
    for (std::ptrdiff_t k = first; k < std::min(f.p, first + group); ++k)
      for (int s = 0; s < S; ++s) {
        float* x = y + s * own;
        const float solved = x[k] * f.inverse_diagonal[k];
        x[k] = solved;
        const V b = hn::Set(D(), solved);
        for (int v = 0; v < vectors; ++v)
          hn::StoreU(hn::NegMulAdd(Entries(A + k * group + v * lanes), b, hn::LoadU(D(), x + first + v * lanes)), D(),
                     x + first + v * lanes);
      }
  }
  constexpr int G = S == 1 && vectors == 1 ? 4 : S <= 2 ? 2 : 1;
  const std::ptrdiff_t groups = below / group;
  std::ptrdiff_t g = 0;
  for (; g + G <= groups; g += G)
    MultiplyGroups<G, S, false>(L2 + g * stride, stride, f.p, y, own, z + g * group, below);
  for (; g < groups; ++g) MultiplyGroups<1, S, false>(L2 + g * stride, stride, f.p, y, own, z + g * group, below);
}

/// sum_k <- (sum_k or 0) + the products of column k of B groups with z, lane by lane, for `count` columns.
template <int B, int S, class Entry>
HWY_INLINE void AddProducts(const Entry* A, std::ptrdiff_t stride, std::ptrdiff_t count, bool clear, const float* z,
                            std::ptrdiff_t z_apart, float* sums) {
  V b[B * vectors][S];
  for (int v = 0; v < B * vectors; ++v)
    for (int s = 0; s < S; ++s) b[v][s] = hn::LoadU(D(), z + s * z_apart + v * lanes);
  for (std::ptrdiff_t k = 0; k < count; ++k, sums += S * lanes) {
    V sum[S];
    for (int s = 0; s < S; ++s) sum[s] = clear ? hn::Zero(D()) : hn::Load(D(), sums + s * lanes);
    for (int g = 0; g < B; ++g)
      for (int v = 0; v < vectors; ++v) {
        const V a = Entries(A + g * stride + k * group + v * lanes);
        for (int s = 0; s < S; ++s) sum[s] = hn::MulAdd(a, b[g * vectors + v][s], sum[s]);
      }
    for (int s = 0; s < S; ++s) hn::Store(sum[s], D(), sums + s * lanes);
  }
}

/// y_k <- y_k - sum over the groups of column k . z for the columns [begin, end). Reads A a few groups at a time, along
/// their columns.
template <int S, class Entry>
HWY_INLINE void SubtractAllProducts(const Entry* A, std::ptrdiff_t stride, std::ptrdiff_t groups, std::ptrdiff_t begin,
                                    std::ptrdiff_t end, const float* z, std::ptrdiff_t z_apart, float* y,
                                    std::ptrdiff_t y_apart) {
  if (groups == 0) return;
  constexpr int B = S > 2 ? 1 : S == 2 ? 2 : 4;
  constexpr std::ptrdiff_t panel = 128;
  HWY_ALIGN float sums[panel * S * lanes];
  for (std::ptrdiff_t k = begin; k < end; k += panel) {
    const std::ptrdiff_t count = std::min(panel, end - k);
    const Entry* from = A + k * group;
    std::ptrdiff_t g = 0;
    for (; g + B <= groups; g += B)
      AddProducts<B, S>(from + g * stride, stride, count, g == 0, z + g * group, z_apart, sums);
    for (; g < groups; ++g) AddProducts<1, S>(from + g * stride, stride, count, g == 0, z + g * group, z_apart, sums);
    for (std::ptrdiff_t c = 0; c < count; ++c)
      for (int s = 0; s < S; ++s)
        y[s * y_apart + k + c] -= hn::GetLane(hn::SumOfLanes(D(), hn::Load(D(), sums + (c * S + s) * lanes)));
  }
}

template <int S, class Entry>
void Backward(const Front& f, const Entry* L1, const Entry* L2, float* y, const float* z) {
  const std::ptrdiff_t stride = f.p * group, own = whole_groups(f.p), below = whole_groups(f.r);
  SubtractAllProducts<S>(L2, stride, below / group, 0, f.p, z, below, y, own);
  for (std::ptrdiff_t g = own / group - 1; g >= 0; --g) {
    const std::ptrdiff_t first = g * group, last = std::min(f.p, first + group);
    const Entry* A = L1 + g * stride;
    // The groups further down, then the triangle.
    SubtractAllProducts<S>(A + stride, stride, own / group - 1 - g, first, last, y + first + group, own, y, own);
    for (int s = 0; s < S; ++s) {
      float* x = y + s * own;
      for (std::ptrdiff_t k = last - 1; k >= first; --k) {
        V sum = hn::Zero(D());
        for (int v = 0; v < vectors; ++v)
          sum = hn::MulAdd(Entries(A + k * group + v * lanes), hn::LoadU(D(), x + first + v * lanes), sum);
        x[k] = (x[k] - hn::GetLane(hn::SumOfLanes(D(), sum))) * f.inverse_diagonal[k];
      }
    }
  }
}

template <class Entry>
HWY_INLINE void ForwardSides(const Front& f, const Entry* L1, const Entry* L2, int sides, float* y, float* z) {
  if (sides == 1)
    Forward<1>(f, L1, L2, y, z);
  else if (sides == 2)
    Forward<2>(f, L1, L2, y, z);
  else
    Forward<4>(f, L1, L2, y, z);
}

void ForwardFront(const Front& f, int sides, float* y, float* z) {
  if (f.rounded1 != nullptr)
    ForwardSides(f, f.rounded1, f.rounded2, sides, y, z);
  else
    ForwardSides(f, f.L1, f.L2, sides, y, z);
}

template <class Entry>
HWY_INLINE void BackwardSides(const Front& f, const Entry* L1, const Entry* L2, int sides, float* y, const float* z) {
  if (sides == 1)
    Backward<1>(f, L1, L2, y, z);
  else if (sides == 2)
    Backward<2>(f, L1, L2, y, z);
  else
    Backward<4>(f, L1, L2, y, z);
}

void BackwardFront(const Front& f, int sides, float* y, const float* z) {
  if (f.rounded1 != nullptr)
    BackwardSides(f, f.rounded1, f.rounded2, sides, y, z);
  else
    BackwardSides(f, f.L1, f.L2, sides, y, z);
}

void RoundFront(const Front& f) {
  if (f.rounded1 == nullptr) return;
  RoundEntries(f.L1, f.rounded1, whole_groups(f.p) * f.p);
  RoundEntries(f.L2, f.rounded2, whole_groups(f.r) * f.p);
}

void FinishSparseRows(const Front& f, float* X) {
  FinishRows<1, false>(f, X, group, X);
}

/// Columns [j, j + W) of M <- (M or 0) - X Y^T; B: the first column's row of Y.
template <int W, bool clear>
HWY_INLINE void SubtractOuter(const float* X, const float* B, std::ptrdiff_t k, float* M) {
  Tile<1, W> tile;
  if (clear) {
    for (auto& row : tile.x)
      for (V& entry : row) entry = hn::Zero(D());
  } else {
    tile.Load(M, group);
  }
  tile.Subtract(X, 0, B, k);
  tile.Store(M, group);
}

void PassRows(const Front& f, const float* X, float* W) {
  const std::ptrdiff_t stride = f.p * group;
  std::ptrdiff_t j = 0;
  for (; j < f.r; j += widest) {  // rows of L2 come in whole groups
    const float* B = f.L2 + j / group * stride + j % group;
    SubtractOuter<widest, true>(X, B, f.p, W + j * group);
  }
}

void SubtractGram(std::ptrdiff_t p, const float* X, const float* Y, float* M) {
  for (std::ptrdiff_t j = 0; j < group; j += widest) SubtractOuter<widest, false>(X, Y + j, p, M + j * group);
}

void SubtractRowProducts(std::ptrdiff_t p, const float* X, const float* v, float* out) {
  MultiplyGroups<1, 1, true>(X, 0, p, v, 0, out, 0);
}

void SubtractRows(std::ptrdiff_t p, const float* X, const float* w, float* v) {
  SubtractAllProducts<1>(X, 0, 1, 0, p, w, 0, v, 0);
}

}  // namespace HWY_NAMESPACE
}  // namespace phiz
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace phiz {

HWY_EXPORT(FactorOwn);
HWY_EXPORT(FactorBelow);
HWY_EXPORT(UpdateFront);
HWY_EXPORT(RoundFront);
HWY_EXPORT(ForwardFront);
HWY_EXPORT(BackwardFront);
HWY_EXPORT(FinishSparseRows);
HWY_EXPORT(PassRows);
HWY_EXPORT(SubtractGram);
HWY_EXPORT(SubtractRowProducts);
HWY_EXPORT(SubtractRows);

int factor_own(const Front& front, const float* F, std::ptrdiff_t ld) {
  return HWY_DYNAMIC_DISPATCH(FactorOwn)(front, F, ld);
}
void factor_below(const Front& front, bool has_negative, const float* F, std::ptrdiff_t ld, std::ptrdiff_t begin,
                  std::ptrdiff_t end) {
  HWY_DYNAMIC_DISPATCH(FactorBelow)(front, has_negative, F, ld, begin, end);
}
void update_front(const Front& front, bool has_negative, float* U, std::ptrdiff_t begin, std::ptrdiff_t end) {
  HWY_DYNAMIC_DISPATCH(UpdateFront)(front, has_negative, U, begin, end);
}
void round_front(const Front& front) {
  HWY_DYNAMIC_DISPATCH(RoundFront)(front);
}
void forward_front(const Front& front, int sides, float* y, float* z) {
  HWY_DYNAMIC_DISPATCH(ForwardFront)(front, sides, y, z);
}
void backward_front(const Front& front, int sides, float* y, const float* z) {
  HWY_DYNAMIC_DISPATCH(BackwardFront)(front, sides, y, z);
}
void finish_rows(const Front& front, float* X) {
  HWY_DYNAMIC_DISPATCH(FinishSparseRows)(front, X);
}
void pass_rows(const Front& front, const float* X, float* W) {
  HWY_DYNAMIC_DISPATCH(PassRows)(front, X, W);
}
void subtract_gram(std::ptrdiff_t p, const float* X, const float* Y, float* M) {
  HWY_DYNAMIC_DISPATCH(SubtractGram)(p, X, Y, M);
}
void subtract_row_products(std::ptrdiff_t p, const float* X, const float* v, float* out) {
  HWY_DYNAMIC_DISPATCH(SubtractRowProducts)(p, X, v, out);
}
void subtract_rows(std::ptrdiff_t p, const float* X, const float* w, float* v) {
  HWY_DYNAMIC_DISPATCH(SubtractRows)(p, X, w, v);
}

}  // namespace phiz
#endif
