// SPDX-License-Identifier: GPL-3.0-or-later
#undef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_RVV)  // the kernel keeps vectors in arrays
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "phiz/elasticity/element_kernel.cpp"
#include "phiz/elasticity/element_kernel.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <cmath>

#include "phiz/numerics/polar3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace phiz {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<double, 8>;
using Lane = hn::Vec<D>;
constexpr D d;

/// B = A S for a symmetric S: xx, yy, zz, xy, xz, yz.
HWY_INLINE void times_stretch(const Lane* A, const Lane* S, Lane* B) {
  constexpr int at[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i)
      B[3 * j + i] = hn::MulAdd(A[6 + i], S[at[2][j]], hn::MulAdd(A[3 + i], S[at[1][j]], hn::Mul(A[i], S[at[0][j]])));
}

/// Deformation gradients of the lanes from `l` on of block b; D9: inverse rest edges.
HWY_INLINE void gradients(const ElementBlocks& e, const double* x, std::ptrdiff_t b, std::size_t l, const Lane* D9,
                          Lane* F) {
  const hn::RebindToSigned<D> di;
  const hn::Rebind<std::int32_t, D> d32;
  Lane corner[4][3];
  for (int c = 0; c < 4; ++c) {
    const auto index = hn::ShiftLeft<2>(
        hn::PromoteTo(di, hn::Load(d32, e.vertex.get() + (b * 4 + c) * 8 + static_cast<std::ptrdiff_t>(l))));
    for (int k = 0; k < 3; ++k) corner[c][k] = hn::GatherIndex(d, x + k, index);
  }
  for (int c = 1; c < 4; ++c)
    for (int k = 0; k < 3; ++k) corner[c][k] = hn::Sub(corner[c][k], corner[0][k]);
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i)
      F[3 * j + i] = hn::MulAdd(corner[3][i], D9[3 * j + 2],
                                hn::MulAdd(corner[2][i], D9[3 * j + 1], hn::Mul(corner[1][i], D9[3 * j])));
}

double EvaluateElements(const ElementBlocks& e, const TermWeights& w, const double* x, double* gradient,
                        std::ptrdiff_t begin, std::ptrdiff_t end) {
  const std::size_t lanes = hn::Lanes(d);
  Lane energy = hn::Zero(d);
  for (std::ptrdiff_t b = begin; b < end; ++b) {
    for (std::size_t l = 0; l < 8; l += lanes) {
      Lane D9[9], F[9], P[9], T[9];
      for (int k = 0; k < 9; ++k) D9[k] = hn::Load(d, e.inverse.get() + (b * 9 + k) * 8 + l);
      gradients(e, x, b, l, D9, F);
      Lane sum = hn::Zero(d);

      const Lane target = hn::Mul(hn::Set(d, w.target), hn::Load(d, e.target_share.get() + b * 8 + l));
      for (int k = 0; k < 9; ++k) {
        const Lane delta = hn::Sub(F[k], hn::Load(d, e.target.get() + (b * 9 + k) * 8 + l));
        P[k] = hn::Mul(target, delta);
        sum = hn::MulAdd(P[k], delta, sum);
      }
      if (w.shape != 0) {
        Lane S[6], G[9], R[9];
        for (int k = 0; k < 6; ++k) S[k] = hn::Load(d, e.stretch.get() + (b * 6 + k) * 8 + l);
        times_stretch(F, S, G);
        ClosestRotation3(d, G, R);
        times_stretch(R, S, T);
        const Lane shape = hn::Set(d, w.shape);
        for (int k = 0; k < 9; ++k) {
          const Lane delta = hn::Sub(F[k], T[k]);
          const Lane force = hn::Mul(shape, delta);
          P[k] = hn::Add(P[k], force);
          sum = hn::MulAdd(force, delta, sum);
        }
      }
      if (w.volume != 0) {
        // The closest matrix of determinant j^3 is j times the closest unimodular matrix to F / j.
        const Lane goal = hn::Load(d, e.goal.get() + b * 8 + l);
        const Lane inverse_goal = hn::Div(hn::Set(d, 1.0), goal);
        Lane G[9];
        for (int k = 0; k < 9; ++k) G[k] = hn::Mul(inverse_goal, F[k]);
        ClosestUnimodular3(d, G, T, 1e-12);  // a step of 1e-6 leaves a strain error of 1e-7
        const Lane volume = hn::Set(d, w.volume);
        for (int k = 0; k < 9; ++k) {
          const Lane delta = hn::NegMulAdd(goal, T[k], F[k]);
          const Lane force = hn::Mul(volume, delta);
          P[k] = hn::Add(P[k], force);
          sum = hn::MulAdd(force, delta, sum);
        }
      }
      const Lane weight = hn::Load(d, e.weight.get() + b * 8 + l);
      energy = hn::MulAdd(weight, sum, energy);

      // Corner c > 0 gets 2 w P D^-T e_c; corner 0 minus their sum.
      const Lane twice = hn::Add(weight, weight);
      Lane first[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
      double* out = gradient + b * 128 + static_cast<std::ptrdiff_t>(l) * 4;
      for (int c = 1; c < 4; ++c) {
        Lane g[3];
        for (int i = 0; i < 3; ++i) {
          g[i] = hn::Mul(twice, hn::MulAdd(P[6 + i], D9[6 + c - 1],
                                           hn::MulAdd(P[3 + i], D9[3 + c - 1], hn::Mul(P[i], D9[c - 1]))));
          first[i] = hn::Sub(first[i], g[i]);
        }
        hn::StoreInterleaved4(g[0], g[1], g[2], hn::Zero(d), d, out + c * 32);
      }
      hn::StoreInterleaved4(first[0], first[1], first[2], hn::Zero(d), d, out);
    }
  }
  return hn::GetLane(hn::SumOfLanes(d, energy));
}

double DeformedVolume(const ElementBlocks& e, const double* rest_volume, const double* x, std::ptrdiff_t begin,
                      std::ptrdiff_t end) {
  const std::size_t lanes = hn::Lanes(d);
  Lane volume = hn::Zero(d);
  for (std::ptrdiff_t b = begin; b < end; ++b)
    for (std::size_t l = 0; l < 8; l += lanes) {
      Lane D9[9], F[9], C[9];
      for (int k = 0; k < 9; ++k) D9[k] = hn::Load(d, e.inverse.get() + (b * 9 + k) * 8 + l);
      gradients(e, x, b, l, D9, F);
      Cofactor3(d, F, C);
      volume = hn::MulAdd(Dot3(F, C), hn::Load(d, rest_volume + b * 8 + static_cast<std::ptrdiff_t>(l)), volume);
    }
  return hn::GetLane(hn::SumOfLanes(d, volume));
}

}  // namespace HWY_NAMESPACE
}  // namespace phiz
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <Eigen/LU>
#include <algorithm>

namespace phiz {

HWY_EXPORT(EvaluateElements);
HWY_EXPORT(DeformedVolume);

ElementBlocks::ElementBlocks(const MatrixX3d& rest, const MatrixX4i& tet_rows, const VectorXd& stiffness,
                             const VectorXd& share)
    : tets(tet_rows.rows()), blocks((tet_rows.rows() + width - 1) / width) {
  const auto count = static_cast<std::size_t>(blocks * width);
  inverse = hwy::AllocateAligned<double>(count * 9);
  weight = hwy::AllocateAligned<double>(count);
  rest_volume = hwy::AllocateAligned<double>(count);
  target_share = hwy::AllocateAligned<double>(count);
  target = hwy::AllocateAligned<double>(count * 9);
  stretch = hwy::AllocateAligned<double>(count * 6);
  goal = hwy::AllocateAligned<double>(count);
  std::fill_n(goal.get(), count, 1.0);
  vertex = hwy::AllocateAligned<std::int32_t>(count * 4);
  for (std::ptrdiff_t slot = 0; slot < blocks * width; ++slot) {
    const std::ptrdiff_t t = std::min(slot, tets - 1);
    const std::ptrdiff_t b = slot / width;
    const std::ptrdiff_t l = slot % width;
    const Vector3d x0 = rest.row(tet_rows(t, 0));
    Matrix3d edges;
    for (int c = 0; c < 3; ++c) edges.col(c) = rest.row(tet_rows(t, c + 1)).transpose() - x0;
    const Matrix3d inverse_edges = edges.inverse();
    for (int k = 0; k < 9; ++k) inverse[static_cast<std::size_t>((b * 9 + k) * width + l)] = inverse_edges.data()[k];
    for (int c = 0; c < 4; ++c) vertex[static_cast<std::size_t>((b * 4 + c) * width + l)] = tet_rows(t, c);
    const double volume = slot < tets ? edges.determinant() / 6 : 0.0;
    rest_volume[static_cast<std::size_t>(slot)] = volume;
    target_share[static_cast<std::size_t>(slot)] = share.size() > 0 ? share[t] : 1.0;
    weight[static_cast<std::size_t>(slot)] = slot < tets ? volume * stiffness[t] : 0.0;
    for (int k = 0; k < 9; ++k) target[static_cast<std::size_t>((b * 9 + k) * width + l)] = k % 4 == 0 ? 1.0 : 0.0;
    for (int k = 0; k < 6; ++k) stretch[static_cast<std::size_t>((b * 6 + k) * width + l)] = k < 3 ? 1.0 : 0.0;
  }
}

double evaluate_elements(const ElementBlocks& elements, const TermWeights& weights, const double* x, double* gradient,
                         std::ptrdiff_t begin, std::ptrdiff_t end) {
  return HWY_DYNAMIC_DISPATCH(EvaluateElements)(elements, weights, x, gradient, begin, end);
}

double deformed_volume(const ElementBlocks& elements, const double* x, std::ptrdiff_t begin, std::ptrdiff_t end) {
  return HWY_DYNAMIC_DISPATCH(DeformedVolume)(elements, elements.rest_volume.get(), x, begin, end);
}

}  // namespace phiz
#endif
