// SPDX-License-Identifier: GPL-3.0-or-later
/// Lane kernels on 3x3 matrices of doubles or floats: nine vectors, one matrix per lane, columns one after the other.
/// For inclusion in sources that are compiled once per vector unit through <hwy/foreach_target.h>.
#if defined(PHIZ_NUMERICS_POLAR3_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PHIZ_NUMERICS_POLAR3_INL_H_
#undef PHIZ_NUMERICS_POLAR3_INL_H_
#else
#define PHIZ_NUMERICS_POLAR3_INL_H_
#endif

#include <hwy/highway.h>

#include "phiz/numerics/svd3.h"

HWY_BEFORE_NAMESPACE();
namespace phiz {
namespace HWY_NAMESPACE {

/// Cofactor matrix: det(A) A^-T.
template <class D, class V = hwy::HWY_NAMESPACE::Vec<D>>
HWY_INLINE void Cofactor3(D, const V* A, V* C) {
  namespace hn = hwy::HWY_NAMESPACE;
  C[0] = hn::MulSub(A[4], A[8], hn::Mul(A[5], A[7]));
  C[1] = hn::MulSub(A[5], A[6], hn::Mul(A[3], A[8]));
  C[2] = hn::MulSub(A[3], A[7], hn::Mul(A[4], A[6]));
  C[3] = hn::MulSub(A[2], A[7], hn::Mul(A[1], A[8]));
  C[4] = hn::MulSub(A[0], A[8], hn::Mul(A[2], A[6]));
  C[5] = hn::MulSub(A[1], A[6], hn::Mul(A[0], A[7]));
  C[6] = hn::MulSub(A[1], A[5], hn::Mul(A[2], A[4]));
  C[7] = hn::MulSub(A[2], A[3], hn::Mul(A[0], A[5]));
  C[8] = hn::MulSub(A[0], A[4], hn::Mul(A[1], A[3]));
}

template <class V>
HWY_INLINE V Dot3(const V* a, const V* b) {
  namespace hn = hwy::HWY_NAMESPACE;
  return hn::MulAdd(a[2], b[2], hn::MulAdd(a[1], b[1], hn::Mul(a[0], b[0])));
}

template <class V>
HWY_INLINE V Dot9(const V* a, const V* b) {
  namespace hn = hwy::HWY_NAMESPACE;
  return hn::Add(Dot3(a, b), hn::Add(Dot3(a + 3, b + 3), Dot3(a + 6, b + 6)));
}

/// C = A B.
template <class V>
HWY_INLINE void Multiply3(const V* A, const V* B, V* C) {
  namespace hn = hwy::HWY_NAMESPACE;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r)
      C[3 * c + r] = hn::MulAdd(A[6 + r], B[3 * c + 2], hn::MulAdd(A[3 + r], B[3 * c + 1], hn::Mul(A[r], B[3 * c])));
}

/// C = A^T B.
template <class V>
HWY_INLINE void TransposeMultiply3(const V* A, const V* B, V* C) {
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) C[3 * c + r] = Dot3(A + 3 * r, B + 3 * c);
}

/// Replaces the marked lanes of P by project(lane of A); lanes that are not finite become the identity.
template <class D, class V = hwy::HWY_NAMESPACE::Vec<D>, class Project>
HWY_NOINLINE void RepairLanes(D d, hwy::HWY_NAMESPACE::Mask<D> marked, const V* A, V* P, const Project& project) {
  namespace hn = hwy::HWY_NAMESPACE;
  using T = hn::TFromD<D>;
  constexpr std::size_t most = 64 / sizeof(T);
  HWY_ALIGN T a[9 * most], p[9 * most], mark[most];
  for (int k = 0; k < 9; ++k) {
    hn::Store(A[k], d, a + k * most);
    hn::Store(P[k], d, p + k * most);
  }
  hn::Store(hn::IfThenElseZero(marked, hn::Set(d, T(1))), d, mark);
  for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
    if (mark[lane] == 0) continue;
    Matrix3d M;
    for (std::size_t k = 0; k < 9; ++k) M.data()[k] = a[k * most + lane];
    const Matrix3d result = M.allFinite() ? Matrix3d(project(M)) : Matrix3d(Matrix3d::Identity());
    for (std::size_t k = 0; k < 9; ++k) p[k * most + lane] = static_cast<T>(result.data()[k]);
  }
  for (int k = 0; k < 9; ++k) P[k] = hn::Load(d, p + k * most);
}

/// One Newton step on the rotations towards the closest one to B, then back onto the rotations.
template <class D, class V = hwy::HWY_NAMESPACE::Vec<D>>
HWY_INLINE void PolishRotation3(D d, const V* B, V* R) {
  namespace hn = hwy::HWY_NAMESPACE;
  using T = hn::TFromD<D>;
  V S[9];
  TransposeMultiply3(R, B, S);
  // With S = R^T B: (tr S I - sym S) w = axial vector of S - S^T, then R <- R exp[w].
  const V half = hn::Set(d, T(0.5));
  const V h01 = hn::Mul(half, hn::Add(S[1], S[3])), h02 = hn::Mul(half, hn::Add(S[2], S[6])),
          h12 = hn::Mul(half, hn::Add(S[5], S[7]));
  const V M[9] = {hn::Add(S[4], S[8]), hn::Neg(h01), hn::Neg(h02), hn::Neg(h01),       hn::Add(S[0], S[8]),
                  hn::Neg(h12),        hn::Neg(h02), hn::Neg(h12), hn::Add(S[0], S[4])};
  V C[9];
  Cofactor3(d, M, C);
  const V det = Dot3(M, C);
  const V axial[3] = {hn::Sub(S[5], S[7]), hn::Sub(S[6], S[2]), hn::Sub(S[1], S[3])};
  V w[3];
  for (int k = 0; k < 3; ++k) w[k] = hn::Div(Dot3(C + 3 * k, axial), det);
  // I + [w] + [w]^2 / 2 = (1 - w.w / 2) I + [w] + w w^T / 2
  const V diagonal = hn::NegMulAdd(half, Dot3(w, w), hn::Set(d, T(1)));
  V E[9];
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) {
      E[3 * c + r] = hn::Mul(half, hn::Mul(w[r], w[c]));
      if (r == c) E[3 * c + r] = hn::Add(E[3 * c + r], diagonal);
    }
  E[1] = hn::Add(E[1], w[2]);
  E[2] = hn::Sub(E[2], w[1]);
  E[3] = hn::Sub(E[3], w[2]);
  E[5] = hn::Add(E[5], w[0]);
  E[6] = hn::Add(E[6], w[1]);
  E[7] = hn::Sub(E[7], w[0]);
  V Q[9];
  Multiply3(R, E, Q);
  // Newton and Schulz: R <- Q (3 I - Q^T Q) / 2.
  V G[9];
  TransposeMultiply3(Q, Q, G);
  for (int k = 0; k < 9; ++k) G[k] = hn::Mul(hn::Set(d, T(-0.5)), G[k]);
  for (int k = 0; k < 9; k += 4) G[k] = hn::Add(G[k], hn::Set(d, T(1.5)));
  Multiply3(Q, G, R);
}

/// R = closest rotation to A (det R = 1, A may be inverted). Davenport's 4x4 eigenvalue by Newton's iteration on its
/// characteristic polynomial, then the closed form of Markley (1993, FOAM); nearly ambiguous lanes go through svd3.
template <class D, class V = hwy::HWY_NAMESPACE::Vec<D>>
HWY_INLINE void ClosestRotation3(D d, const V* A, V* R) {
  namespace hn = hwy::HWY_NAMESPACE;
  using T = hn::TFromD<D>;
  constexpr bool full = sizeof(T) == sizeof(double);
  constexpr T tiny = static_cast<T>(full ? 1e-200 : 1e-25), huge = 1 / tiny;
  const V one = hn::Set(d, T(1));
  const V norm2 = Dot9(A, A);
  auto bad = hn::Not(hn::And(hn::Gt(norm2, hn::Set(d, tiny)), hn::Lt(norm2, hn::Set(d, huge))));
  const V scale = hn::Div(one, hn::Sqrt(hn::IfThenElse(bad, one, norm2)));
  V B[9], C[9];
  for (int k = 0; k < 9; ++k) B[k] = hn::Mul(A[k], scale);
  Cofactor3(d, B, C);
  const V det = Dot3(B, C);
  // The largest root of x^4 - 2 x^2 - 8 det x + 1 - 4 |C|^2 is s0 + s1 + s2; it is approached from above, |B| = 1.
  const V linear = hn::Mul(hn::Set(d, T(-8.0)), det);
  const V constant = hn::NegMulAdd(hn::Set(d, T(4.0)), Dot9(C, C), one);
  V x = hn::Set(d, T(1.7320508075688774));
  bool done = false;
  for (int i = 0; i < 12 && !done; ++i) {
    const V x2 = hn::Mul(x, x);
    const V value = hn::MulAdd(x, hn::MulAdd(x, hn::Sub(x2, hn::Set(d, T(2.0))), linear), constant);
    const V slope = hn::MulAdd(hn::Set(d, T(4.0)), hn::Mul(x, hn::Sub(x2, one)), linear);
    const V step = hn::Div(value, slope);
    const auto live = hn::Gt(slope, hn::Set(d, T(1e-3)));
    bad = hn::Or(bad, hn::Not(live));
    x = hn::Sub(x, hn::IfThenElseZero(live, step));
    // The error after a step is of the order of the square of its length.
    const auto settled = hn::Or(bad, hn::Lt(hn::Abs(step), hn::Set(d, T(full ? 1e-9 : 2e-4))));
    done = hn::AllTrue(d, settled);
    if (i == 11) bad = hn::Or(bad, hn::Not(settled));
  }
  const V kappa = hn::Mul(hn::Set(d, T(0.5)), hn::MulSub(x, x, one));
  const V zeta = hn::MulSub(kappa, x, det);  // (s0 + s1) (s1 + s2) (s2 + s0)
  bad = hn::Or(bad, hn::Not(hn::Gt(zeta, hn::Set(d, T(1e-2)))));
  const V inverse = hn::Div(one, hn::IfThenElse(bad, one, zeta));
  V M[9], BM[9];
  TransposeMultiply3(B, B, M);
  Multiply3(B, M, BM);
  const V along = hn::Mul(inverse, hn::Add(kappa, one)), across = hn::Mul(inverse, x);
  for (int k = 0; k < 9; ++k) R[k] = hn::MulAdd(along, B[k], hn::MulSub(across, C[k], hn::Mul(inverse, BM[k])));
  if (!hn::AllTrue(d, hn::Or(bad, hn::Gt(zeta, hn::Set(d, T(0.5)))))) PolishRotation3(d, B, R);
  if (!hn::AllFalse(d, bad)) RepairLanes(d, bad, A, R, [](const Matrix3d& F) { return closest_rotation(F); });
}

/// P = closest matrix of determinant 1: E = P - A stays parallel to the cofactors of P while det P = 1 is solved by
/// successive linearisation, until the squared change of a step falls below `least_change2`; lanes far from determinant
/// 1 go through svd3.
template <class D, class V = hwy::HWY_NAMESPACE::Vec<D>>
HWY_INLINE void ClosestUnimodular3(D d, const V* A, V* P, double least_change2 = 1e-26) {
  namespace hn = hwy::HWY_NAMESPACE;
  using T = hn::TFromD<D>;
  const V one = hn::Set(d, T(1));
  V C[9], E[9];
  for (int k = 0; k < 9; ++k) {
    P[k] = A[k];
    E[k] = hn::Zero(d);
  }
  auto bad = hn::Lt(one, hn::Zero(d));
  bool done = false;
  for (int i = 0; i < 24 && !done; ++i) {
    Cofactor3(d, P, C);
    const V det = Dot3(P, C);
    if (i == 0) bad = hn::Not(hn::And(hn::Gt(det, hn::Set(d, T(0.3))), hn::Lt(det, hn::Set(d, T(2)))));
    const V along = hn::Div(hn::Sub(Dot9(C, E), hn::Sub(det, one)), hn::IfThenElse(bad, one, Dot9(C, C)));
    V change = hn::Zero(d);
    for (int k = 0; k < 9; ++k) {
      const V next = hn::Mul(along, C[k]);
      const V step = hn::Sub(next, E[k]);
      change = hn::MulAdd(step, step, change);
      E[k] = next;
      P[k] = hn::Add(A[k], next);
    }
    const auto settled = hn::Or(bad, hn::Lt(change, hn::Set(d, static_cast<T>(least_change2))));
    done = hn::AllTrue(d, settled);
    if (i == 23) bad = hn::Or(bad, hn::Not(settled));
  }
  if (!hn::AllFalse(d, bad)) RepairLanes(d, bad, A, P, [](const Matrix3d& F) { return closest_unimodular(F); });
}

}  // namespace HWY_NAMESPACE
}  // namespace phiz
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
