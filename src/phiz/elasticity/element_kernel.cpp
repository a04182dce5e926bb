// SPDX-License-Identifier: GPL-3.0-or-later
#undef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_RVV)  // the kernel keeps vectors in arrays
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "phiz/elasticity/element_kernel.cpp"
#include "phiz/elasticity/element_kernel.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "phiz/elasticity/tet_lanes-inl.h"
#include "phiz/numerics/polar3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace phiz {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <class T>
double EvaluateElements(const ElementBlocks<T>& e, const TermWeights& w, const double* x, T* gradient,
                        std::ptrdiff_t begin, std::ptrdiff_t end) {
  using Blocks = ElementBlocks<T>;
  constexpr auto width = static_cast<std::size_t>(Blocks::width);
  const hn::CappedTag<T, width> d;
  using V = hn::Vec<decltype(d)>;
  // A step of 1e-6 leaves a strain error of about 1e-7.
  constexpr double least_change2 = sizeof(T) == sizeof(double) ? 1e-12 : 1e-11;
  V energy = hn::Zero(d);
  for (std::ptrdiff_t b = begin; b < end; ++b) {
    for (std::size_t l = 0; l < width; l += hn::Lanes(d)) {
      const std::ptrdiff_t slot = b * Blocks::width + static_cast<std::ptrdiff_t>(l);
      V D9[9], E[9], F[9], P[9], Q[9];
      for (int k = 0; k < 9; ++k) D9[k] = hn::Load(d, e.inverse.get() + Blocks::at(slot, 9, k));
      Edges(d, e.vertex.get() + 4 * slot, x, E);
      Multiply3(E, D9, F);
      V sum = hn::Zero(d);

      const V target = hn::Mul(hn::Set(d, static_cast<T>(w.target)), hn::Load(d, e.target_share.get() + slot));
      for (int k = 0; k < 9; ++k) {
        const V delta = hn::Sub(F[k], hn::Load(d, e.target.get() + Blocks::at(slot, 9, k)));
        P[k] = hn::Mul(target, delta);
        sum = hn::MulAdd(P[k], delta, sum);
      }
      const auto add_term = [&](double weight, const V* projection) {
        const V factor = hn::Set(d, static_cast<T>(weight));
        for (int k = 0; k < 9; ++k) {
          const V delta = hn::Sub(F[k], projection[k]);
          const V force = hn::Mul(factor, delta);
          P[k] = hn::Add(P[k], force);
          sum = hn::MulAdd(force, delta, sum);
        }
      };
      if (w.shape != 0) {
        V S[6], G[9], R[9];
        for (int k = 0; k < 6; ++k) S[k] = hn::Load(d, e.stretch.get() + Blocks::at(slot, 6, k));
        TimesStretch(F, S, G);
        ClosestRotation3(d, G, R);
        TimesStretch(R, S, Q);
        add_term(w.shape, Q);
      }
      if (w.volume != 0) {
        // The closest matrix of determinant j^3 is j times the closest unimodular matrix to F / j.
        const V goal = hn::Load(d, e.goal.get() + slot);
        const V inverse_goal = hn::Div(hn::Set(d, T(1)), goal);
        V G[9];
        for (int k = 0; k < 9; ++k) G[k] = hn::Mul(inverse_goal, F[k]);
        ClosestUnimodular3(d, G, Q, least_change2);
        for (int k = 0; k < 9; ++k) Q[k] = hn::Mul(goal, Q[k]);
        add_term(w.volume, Q);
      }
      const V weight = hn::Load(d, e.weight.get() + slot);
      energy = hn::MulAdd(weight, sum, energy);

      const V twice = hn::Add(weight, weight);
      for (V& p : P) p = hn::Mul(twice, p);
      StoreCornerForces(d, P, D9, 4 * width, gradient + 4 * Blocks::at(slot, 4, 0));
    }
  }
  HWY_ALIGN T parts[width];
  hn::Store(energy, d, parts);
  double total = 0;
  for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) total += static_cast<double>(parts[lane]);
  return total;
}

double EvaluateFull(const ElementBlocks<double>& e, const TermWeights& w, const double* x, double* gradient,
                    std::ptrdiff_t begin, std::ptrdiff_t end) {
  return EvaluateElements(e, w, x, gradient, begin, end);
}

double EvaluateSingle(const ElementBlocks<float>& e, const TermWeights& w, const double* x, float* gradient,
                      std::ptrdiff_t begin, std::ptrdiff_t end) {
  return EvaluateElements(e, w, x, gradient, begin, end);
}

}  // namespace HWY_NAMESPACE
}  // namespace phiz
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>

namespace phiz {

HWY_EXPORT(EvaluateFull);
HWY_EXPORT(EvaluateSingle);

template <class T>
ElementBlocks<T>::ElementBlocks(const MatrixX3d& rest, const MatrixX4i& tet_rows, const VectorXd& stiffness,
                                const VectorXd& share)
    : tets(tet_rows.rows()), blocks((tet_rows.rows() + width - 1) / width) {
  const auto count = static_cast<std::size_t>(blocks * width);
  inverse = hwy::AllocateAligned<T>(count * 9);
  weight = hwy::AllocateAligned<T>(count);
  target_share = hwy::AllocateAligned<T>(count);
  target = hwy::AllocateAligned<T>(count * 9);
  stretch = hwy::AllocateAligned<T>(count * 6);
  goal = hwy::AllocateAligned<T>(count);
  vertex = hwy::AllocateAligned<std::int32_t>(count * 4);
  for (std::ptrdiff_t slot = 0; slot < blocks * width; ++slot) {
    const auto s = static_cast<std::size_t>(slot);
    const std::ptrdiff_t t = std::min(slot, tets - 1);
    const Vector3d x0 = rest.row(tet_rows(t, 0));
    Matrix3d edges;
    for (int c = 0; c < 3; ++c) edges.col(c) = rest.row(tet_rows(t, c + 1)).transpose() - x0;
    const Matrix3d inverse_edges = edges.inverse();
    for (int c = 0; c < 4; ++c) vertex[4 * s + static_cast<std::size_t>(c)] = tet_rows(t, c);
    weight[s] = static_cast<T>(slot < tets ? edges.determinant() / 6 * stiffness[t] : 0);
    target_share[s] = static_cast<T>(share.size() > 0 ? share[t] : 1);
    goal[s] = 1;
    for (int k = 0; k < 9; ++k) {
      inverse[at(slot, 9, k)] = static_cast<T>(inverse_edges.data()[k]);
      target[at(slot, 9, k)] = k % 4 == 0 ? 1 : 0;
    }
    for (int k = 0; k < 6; ++k) stretch[at(slot, 6, k)] = k < 3 ? 1 : 0;
  }
}

double evaluate_elements(const ElementBlocks<double>& elements, const TermWeights& weights, const double* x,
                         double* gradient, std::ptrdiff_t begin, std::ptrdiff_t end) {
  return HWY_DYNAMIC_DISPATCH(EvaluateFull)(elements, weights, x, gradient, begin, end);
}

double evaluate_elements(const ElementBlocks<float>& elements, const TermWeights& weights, const double* x,
                         float* gradient, std::ptrdiff_t begin, std::ptrdiff_t end) {
  return HWY_DYNAMIC_DISPATCH(EvaluateSingle)(elements, weights, x, gradient, begin, end);
}

template <class T>
double deformed_volume(const ElementBlocks<T>& elements, const double* x, std::ptrdiff_t begin, std::ptrdiff_t end) {
  double volume = 0;
  for (std::ptrdiff_t slot = begin; slot < std::min(end, elements.tets); ++slot) {
    const std::int32_t* corner = elements.vertex.get() + 4 * slot;
    const auto edge = [&](int c) {
      return Vector3d(Eigen::Map<const Vector3d>(x + 4 * static_cast<std::ptrdiff_t>(corner[c])) -
                      Eigen::Map<const Vector3d>(x + 4 * static_cast<std::ptrdiff_t>(corner[0])));
    };
    volume += edge(1).dot(edge(2).cross(edge(3))) / 6;
  }
  return volume;
}

template struct ElementBlocks<double>;
template struct ElementBlocks<float>;
template double deformed_volume(const ElementBlocks<double>&, const double*, std::ptrdiff_t, std::ptrdiff_t);
template double deformed_volume(const ElementBlocks<float>&, const double*, std::ptrdiff_t, std::ptrdiff_t);

}  // namespace phiz
#endif
