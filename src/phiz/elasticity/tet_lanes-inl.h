// SPDX-License-Identifier: GPL-3.0-or-later
/// Lane kernels shared by the element kernels: one tet per lane. For inclusion in sources that are compiled once per
/// vector unit through <hwy/foreach_target.h>.
#if defined(PHIZ_ELASTICITY_TET_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PHIZ_ELASTICITY_TET_LANES_INL_H_
#undef PHIZ_ELASTICITY_TET_LANES_INL_H_
#else
#define PHIZ_ELASTICITY_TET_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace phiz {
namespace HWY_NAMESPACE {

/// B = A S for a symmetric S: xx, yy, zz, xy, xz, yz.
template <class V>
HWY_INLINE void TimesStretch(const V* A, const V* S, V* B) {
  namespace hn = hwy::HWY_NAMESPACE;
  constexpr int at[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i)
      B[3 * j + i] = hn::MulAdd(A[6 + i], S[at[2][j]], hn::MulAdd(A[3 + i], S[at[1][j]], hn::Mul(A[i], S[at[0][j]])));
}

/// Edges from corner 0 to the others (columns). `vertex`: four corners per lane; `x`: four doubles per vertex.
template <class D, class V = hwy::HWY_NAMESPACE::Vec<D>>
HWY_INLINE void Edges(D d, const std::int32_t* vertex, const double* x, V* E) {
  namespace hn = hwy::HWY_NAMESPACE;
  using T = hn::TFromD<D>;
  constexpr std::size_t most = 64 / sizeof(T);
  HWY_ALIGN T rows[3][4 * most];
  for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane, vertex += 4) {
    const double* origin = x + 4 * static_cast<std::ptrdiff_t>(vertex[0]);
    for (int c = 0; c < 3; ++c) {
      const double* corner = x + 4 * static_cast<std::ptrdiff_t>(vertex[c + 1]);
      for (std::size_t k = 0; k < 4; ++k) rows[c][4 * lane + k] = static_cast<T>(corner[k] - origin[k]);
    }
  }
  V unused;
  for (int c = 0; c < 3; ++c) hn::LoadInterleaved4(d, rows[c], E[3 * c], E[3 * c + 1], E[3 * c + 2], unused);
}

/// Stores the forces P h_c on the corners of the lanes from `gradient` on, four values per lane and corner, corners
/// `apart` values from each other. D9: inverse of the rest edges, whose rows are the hat gradients h of corners 1 to 3.
template <class D, class V = hwy::HWY_NAMESPACE::Vec<D>, class T = hwy::HWY_NAMESPACE::TFromD<D>>
HWY_INLINE void StoreCornerForces(D d, const V* P, const V* D9, std::size_t apart, T* gradient) {
  namespace hn = hwy::HWY_NAMESPACE;
  V first[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  for (int c = 1; c < 4; ++c) {
    V g[3];
    for (int i = 0; i < 3; ++i) {
      g[i] = hn::MulAdd(P[6 + i], D9[6 + c - 1], hn::MulAdd(P[3 + i], D9[3 + c - 1], hn::Mul(P[i], D9[c - 1])));
      first[i] = hn::Sub(first[i], g[i]);
    }
    hn::StoreInterleaved4(g[0], g[1], g[2], hn::Zero(d), d, gradient + static_cast<std::size_t>(c) * apart);
  }
  hn::StoreInterleaved4(first[0], first[1], first[2], hn::Zero(d), d, gradient);
}

}  // namespace HWY_NAMESPACE
}  // namespace phiz
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
