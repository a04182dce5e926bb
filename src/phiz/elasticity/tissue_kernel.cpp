// SPDX-License-Identifier: GPL-3.0-or-later
#undef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_RVV)  // the kernel keeps vectors in arrays
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "phiz/elasticity/tissue_kernel.cpp"
#include "phiz/elasticity/tissue_kernel.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "phiz/elasticity/tet_lanes-inl.h"
#include "phiz/numerics/polar3-inl.h"

// clang-format off: it wants to be last
#include <hwy/contrib/math/math-inl.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace phiz {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, 16>;
using V = hn::Vec<D>;
using Blocks = TissueBlocks;

HWY_INLINE V Number(double value) {
  return hn::Set(D(), static_cast<float>(value));
}

HWY_INLINE void Load(const float* array, std::ptrdiff_t slot, int entries, V* out) {
  for (int k = 0; k < entries; ++k) out[k] = hn::LoadU(D(), array + Blocks::at(slot, entries, k));
}

/// Determinant of a symmetric matrix: xx, yy, zz, xy, xz, yz.
HWY_INLINE V SymmetricDeterminant(const V* S) {
  const V a = hn::MulSub(S[1], S[2], hn::Mul(S[5], S[5]));
  const V b = hn::MulSub(S[3], S[2], hn::Mul(S[5], S[4]));
  const V c = hn::MulSub(S[3], S[5], hn::Mul(S[1], S[4]));
  return hn::MulAdd(S[4], c, hn::NegMulAdd(S[3], b, hn::Mul(S[0], a)));
}

/// Edges from corner 0 to the others of a block: four values per tet, edge after edge. To be called well before they
/// are used: loads must not wait for stores.
HWY_INLINE void GatherEdges(const Blocks& e, const double* x, std::ptrdiff_t block, float* edges) {
  const hn::CappedTag<double, 4> wide;
  const hn::Rebind<float, decltype(wide)> narrow;
  const std::int32_t* vertex = e.vertex.get() + 4 * Blocks::width * block;
  for (std::ptrdiff_t lane = 0; lane < Blocks::width; ++lane, vertex += 4)
    for (std::size_t part = 0; part < 4; part += hn::Lanes(wide)) {
      const auto origin = hn::LoadU(wide, x + 4 * static_cast<std::ptrdiff_t>(vertex[0]) + part);
      for (int c = 0; c < 3; ++c) {
        const auto corner = hn::LoadU(wide, x + 4 * static_cast<std::ptrdiff_t>(vertex[c + 1]) + part);
        hn::StoreU(hn::DemoteTo(narrow, hn::Sub(corner, origin)), narrow,
                   edges + 4 * (Blocks::width * c + lane) + part);
      }
    }
}
constexpr std::ptrdiff_t edge_floats = 12 * Blocks::width;

/// What all laws need of the tets from `slot` on.
struct State {
  V D9[9], F[9], C[9], J, volume, mu, lambda, active;

  /// `edges`: as GatherEdges() leaves them.
  HWY_INLINE State(const Blocks& e, const float* edges, std::ptrdiff_t slot) {
    V E[9];
    V unused;
    Load(e.inverse.get(), slot, 9, D9);
    for (int c = 0; c < 3; ++c)
      hn::LoadInterleaved4(D(), edges + 4 * Blocks::width * c, E[3 * c], E[3 * c + 1], E[3 * c + 2], unused);
    Multiply3(E, D9, F);
    Cofactor3(D(), F, C);
    J = Dot3(F, C);
    Load(e.volume.get(), slot, 1, &volume);
    Load(e.mu.get(), slot, 1, &mu);
    Load(e.lambda.get(), slot, 1, &lambda);
    Load(e.active.get(), slot, 1, &active);
  }
};

/// Adds weight (mu |F - R S|^2 + lambda (J - J_S)^2) and its derivative.
HWY_INLINE void AddCorotated(const State& s, V weight, const V* RS, V goal, V& energy, V* P) {
  const V mu = hn::Mul(weight, s.mu), lambda = hn::Mul(weight, s.lambda), excess = hn::Sub(s.J, goal);
  const V twice_mu = hn::Add(mu, mu), pressure = hn::Mul(hn::Add(lambda, lambda), excess);
  V sum = hn::Zero(D());
  for (int k = 0; k < 9; ++k) {
    const V delta = hn::Sub(s.F[k], RS[k]);
    sum = hn::MulAdd(delta, delta, sum);
    P[k] = hn::MulAdd(twice_mu, delta, hn::MulAdd(pressure, s.C[k], P[k]));
  }
  energy = hn::MulAdd(mu, sum, hn::MulAdd(lambda, hn::Mul(excess, excess), energy));
}

/// The constants of constitutive.cpp.
struct NeoHookean {
  V mu, lambda, alpha;
  HWY_INLINE explicit NeoHookean(const State& s) {
    mu = hn::Mul(Number(4.0 / 3), s.mu);
    lambda = hn::MulAdd(Number(2), s.lambda, hn::Mul(Number(5.0 / 6), s.mu));
    alpha = hn::MulAdd(Number(0.75), hn::Div(mu, lambda), Number(1));
  }
};

HWY_INLINE void AddNeoHookean(const State& s, V weight, V& energy, V* P) {
  const NeoHookean n(s);
  const V I = Dot9(s.F, s.F), excess = hn::Sub(s.J, n.alpha), at_rest = hn::Sub(Number(1), n.alpha);
  const V mu = hn::Mul(weight, n.mu), lambda = hn::Mul(weight, n.lambda);
  const V stretch = hn::Sub(hn::Sub(I, Number(3)), hn::Log(D(), hn::Mul(Number(0.25), hn::Add(I, Number(1)))));
  const V volume = hn::MulSub(excess, excess, hn::Mul(at_rest, at_rest));
  energy = hn::MulAdd(Number(0.5), hn::MulAdd(mu, stretch, hn::Mul(lambda, volume)), energy);
  const V shear = hn::Mul(mu, hn::Div(I, hn::Add(I, Number(1)))), pressure = hn::Mul(lambda, excess);
  for (int k = 0; k < 9; ++k) P[k] = hn::MulAdd(shear, s.F[k], hn::MulAdd(pressure, s.C[k], P[k]));
}

/// Adds the forces P h_c of a vector of tets to the sums of their corners, with their norms.
HWY_INLINE void AddForces(const Blocks& e, const V* P, const V* D9, std::ptrdiff_t slot, float* sums) {
  constexpr D d;
  HWY_ALIGN float forces[4][4 * Blocks::width];
  V first[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  for (int c = 1; c < 4; ++c) {
    V f[3];
    for (int i = 0; i < 3; ++i) {
      f[i] = hn::MulAdd(P[6 + i], D9[6 + c - 1], hn::MulAdd(P[3 + i], D9[3 + c - 1], hn::Mul(P[i], D9[c - 1])));
      first[i] = hn::Sub(first[i], f[i]);
    }
    hn::StoreInterleaved4(f[0], f[1], f[2], hn::Sqrt(Dot3(f, f)), d, forces[c]);
  }
  hn::StoreInterleaved4(first[0], first[1], first[2], hn::Sqrt(Dot3(first, first)), d, forces[0]);
  const hn::CappedTag<float, 4> four;
  const std::uint16_t* local = e.local.data() + 4 * slot;
  for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane, local += 4)
    for (std::size_t c = 0; c < 4; ++c)
      for (std::size_t part = 0; part < 4; part += hn::Lanes(four)) {
        float* sum = sums + 4 * static_cast<std::size_t>(local[c]) + part;
        hn::StoreU(hn::Add(hn::LoadU(four, sum), hn::LoadU(four, forces[c] + 4 * lane + part)), four, sum);
      }
}

double EvaluateTissue(const Blocks& e, const double* x, std::ptrdiff_t chunk, float* sums) {
  constexpr D d;
  const std::ptrdiff_t begin = chunk * Blocks::chunk, end = HWY_MIN(begin + Blocks::chunk, e.blocks);
  HWY_ALIGN float edges[2][edge_floats];
  GatherEdges(e, x, begin, edges[0]);
  double total = 0;
  for (std::ptrdiff_t b = begin; b < end; ++b) {
    if (b + 1 < end) GatherEdges(e, x, b + 1, edges[(b + 1 - begin) % 2]);
    V energy = hn::Zero(d);
    for (std::size_t l = 0; l < Blocks::width; l += hn::Lanes(d)) {
      const std::ptrdiff_t slot = b * Blocks::width + static_cast<std::ptrdiff_t>(l);
      const State s(e, edges[(b - begin) % 2] + 4 * l, slot);
      V P[9], R[9], sum = hn::Zero(d);
      for (V& p : P) p = hn::Zero(d);
      const V passive = hn::Sub(Number(1), s.active);
      if (e.passive == PassiveLaw::corotated) {
        ClosestRotation3(d, s.F, R);
        AddCorotated(s, passive, R, Number(1), sum, P);
      } else {
        AddNeoHookean(s, passive, sum, P);
      }
      if (b < e.muscle_blocks) {
        V S[6], G[9], RS[9];
        Load(e.stretch.get(), slot, 6, S);
        TimesStretch(s.F, S, G);
        ClosestRotation3(d, G, R);
        TimesStretch(R, S, RS);
        AddCorotated(s, s.active, RS, SymmetricDeterminant(S), sum, P);
      }
      energy = hn::MulAdd(s.volume, sum, energy);
      for (V& p : P) p = hn::Mul(s.volume, p);
      AddForces(e, P, s.D9, slot, sums);
    }
    total += static_cast<double>(hn::GetLane(hn::SumOfLanes(d, energy)));
  }
  return total;
}

/// Hat gradients of the four corners, three each.
HWY_INLINE void HatGradients(const V* D9, V h[4][3]) {
  for (int k = 0; k < 3; ++k) {
    h[0][k] = hn::Zero(D());
    for (int c = 1; c < 4; ++c) {
      h[c][k] = D9[3 * k + c - 1];
      h[0][k] = hn::Sub(h[0][k], h[c][k]);
    }
  }
}

HWY_INLINE void Times(const V* A, const V* v, V* out) {
  for (int i = 0; i < 3; ++i) out[i] = hn::MulAdd(A[6 + i], v[2], hn::MulAdd(A[3 + i], v[1], hn::Mul(A[i], v[0])));
}

HWY_INLINE void Cross(const V* a, const V* b, V* out) {
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    out[i] = hn::MulSub(a[j], b[k], hn::Mul(a[k], b[j]));
  }
}

/// Adds the second derivative of weight min_R |F - R S|^2: for corners with hat gradients g, h in F and S g, S h in F S
/// it is 2 (g . h) I - 2 A^T M B with the twists A = [S g] R^T, B = [S h] R^T and M = (tr Y I - Y)^-1, Y = R^T F S.
template <bool muscle>
HWY_INLINE void AddShape(const State& s, V weight, const V* S, double least_curvature, const V h[4][3], V K[10][9]) {
  constexpr D d;
  V G[9], R[9], Y[9], N[9], M[9];
  if (muscle)
    TimesStretch(s.F, S, G);
  else
    for (int k = 0; k < 9; ++k) G[k] = s.F[k];
  ClosestRotation3(d, G, R);
  TransposeMultiply3(R, G, Y);
  const V half = Number(0.5);
  const V y01 = hn::Mul(half, hn::Add(Y[1], Y[3])), y02 = hn::Mul(half, hn::Add(Y[2], Y[6])),
          y12 = hn::Mul(half, hn::Add(Y[5], Y[7]));
  N[0] = hn::Add(Y[4], Y[8]);
  N[4] = hn::Add(Y[0], Y[8]);
  N[8] = hn::Add(Y[0], Y[4]);
  N[1] = N[3] = hn::Neg(y01);
  N[2] = N[6] = hn::Neg(y02);
  N[5] = N[7] = hn::Neg(y12);
  Cofactor3(d, N, M);
  // Where F S is collapsed the rotation turns without effort and the term has no second derivative.
  const V det = Dot3(N, M), trace = hn::Add(N[0], hn::Add(N[4], N[8]));
  const V least = hn::Mul(Number(1e-6), hn::Abs(hn::Mul(trace, hn::Mul(trace, trace))));
  const auto regular = hn::Gt(det, least);
  const V inverse = hn::IfThenElseZero(regular, hn::Div(Number(1), hn::IfThenElse(regular, det, Number(1))));
  for (V& m : M) m = hn::Mul(inverse, m);
  if (least_curvature > any_curvature) {
    // The smallest eigenvalue of N from below; the twist with it has the curvature 2 - 4 / nu
    // in relaxed tissue.
    const V minors =
        hn::Add(hn::MulSub(N[0], N[4], hn::Mul(N[1], N[1])),
                hn::Add(hn::MulSub(N[4], N[8], hn::Mul(N[5], N[5])), hn::MulSub(N[0], N[8], hn::Mul(N[2], N[2]))));
    V nu = hn::Neg(hn::Sqrt(Dot9(N, N)));
    constexpr int steps = 12;
    for (int i = 0; i < steps; ++i) {
      const V value = hn::MulSub(hn::MulAdd(hn::Sub(nu, trace), nu, minors), nu, det);
      const V slope = hn::MulAdd(hn::MulSub(Number(3), nu, hn::Add(trace, trace)), nu, minors);
      nu = hn::Sub(nu, hn::IfThenElseZero(hn::Gt(slope, Number(1e-12)), hn::Div(value, slope)));
    }
    V share = hn::Mul(nu, Number(0.5 * (1 - least_curvature)));
    if (muscle) {
      // A stretch S turns with up to the square of its largest eigenvalue, which no row sum is below.
      const V xy = hn::Abs(S[3]), xz = hn::Abs(S[4]), yz = hn::Abs(S[5]);
      const V x = hn::Add(hn::Abs(S[0]), hn::Add(xy, xz)), y = hn::Add(hn::Abs(S[1]), hn::Add(xy, yz)),
              z = hn::Add(hn::Abs(S[2]), hn::Add(xz, yz));
      const V largest = hn::Max(x, hn::Max(y, z));
      share = hn::Div(share, hn::Mul(largest, largest));
    }
    const V weaker = hn::Min(Number(1), hn::Max(hn::Zero(d), share));
    for (V& m : M) m = hn::Mul(weaker, m);
  }
  const V factor = hn::Mul(Number(2), hn::Mul(weight, s.mu));
  // Twists by rows of 3: column i is (S h) x (row i of R).
  V A[4][9];
  for (int c = 0; c < 4; ++c) {
    V g[3] = {h[c][0], h[c][1], h[c][2]};
    if (muscle) {
      g[0] = hn::MulAdd(S[0], h[c][0], hn::MulAdd(S[3], h[c][1], hn::Mul(S[4], h[c][2])));
      g[1] = hn::MulAdd(S[3], h[c][0], hn::MulAdd(S[1], h[c][1], hn::Mul(S[5], h[c][2])));
      g[2] = hn::MulAdd(S[4], h[c][0], hn::MulAdd(S[5], h[c][1], hn::Mul(S[2], h[c][2])));
    }
    for (int i = 0; i < 3; ++i) {
      const V r[3] = {R[i], R[3 + i], R[6 + i]};
      Cross(g, r, A[c] + 3 * i);
    }
  }
  V MB[4][9];
  for (int c = 0; c < 4; ++c)
    for (int i = 0; i < 3; ++i) Times(M, A[c] + 3 * i, MB[c] + 3 * i);
  for (int pair = 0; pair < 10; ++pair) {
    const int a = corner_pairs[pair][0], b = corner_pairs[pair][1];
    const V along = hn::Mul(factor, Dot3(h[a], h[b]));
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < 3; ++i) {
        V& entry = K[pair][3 * k + i];
        entry = hn::NegMulAdd(factor, Dot3(A[a] + 3 * i, MB[b] + 3 * k), entry);
        if (i == k) entry = hn::Add(entry, along);
      }
  }
}

/// Adds stiff (C g)(C h)^T + pressure d2J/dF2 per pair of corners.
HWY_INLINE void AddVolume(const State& s, V stiff, V pressure, const V h[4][3], V K[10][9]) {
  V c[4][3];
  for (int corner = 0; corner < 4; ++corner) Times(s.C, h[corner], c[corner]);
  for (int pair = 0; pair < 10; ++pair) {
    const int a = corner_pairs[pair][0], b = corner_pairs[pair][1];
    for (int k = 0; k < 3; ++k) {
      const V scaled = hn::Mul(stiff, c[b][k]);
      for (int i = 0; i < 3; ++i) K[pair][3 * k + i] = hn::MulAdd(scaled, c[a][i], K[pair][3 * k + i]);
    }
    if (a == b) continue;
    // u . d2J v = (u x v) . F (g x h).
    V w[3], f[3];
    Cross(h[a], h[b], w);
    Times(s.F, w, f);
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      const V value = hn::Mul(pressure, f[k]);
      K[pair][3 * j + i] = hn::Add(K[pair][3 * j + i], value);
      K[pair][3 * i + j] = hn::Sub(K[pair][3 * i + j], value);
    }
  }
}

/// A pressure that neither stretches nor twists below the least curvature.
HWY_INLINE V BoundedPressure(const State& s, V pressure, double least_curvature) {
  if (least_curvature <= any_curvature) return pressure;
  const V unit = hn::Div(hn::Add(s.mu, s.mu), hn::Sqrt(hn::Max(Dot9(s.F, s.F), Number(1e-12))));
  return hn::Min(hn::Max(pressure, hn::Mul(unit, Number(least_curvature))), hn::Mul(unit, Number(1 - least_curvature)));
}

HWY_INLINE void AddNeoHookeanStiffness(const State& s, V weight, double least_curvature, const V h[4][3], V K[10][9]) {
  const NeoHookean n(s);
  const V I = hn::Add(Dot9(s.F, s.F), Number(1)), mu = hn::Mul(weight, n.mu), lambda = hn::Mul(weight, n.lambda);
  const V inverse = hn::Div(Number(1), I);
  const V shear = hn::NegMulAdd(mu, inverse, mu), growth = hn::Mul(Number(2), hn::Mul(mu, hn::Mul(inverse, inverse)));
  V f[4][3];
  for (int corner = 0; corner < 4; ++corner) Times(s.F, h[corner], f[corner]);
  for (int pair = 0; pair < 10; ++pair) {
    const int a = corner_pairs[pair][0], b = corner_pairs[pair][1];
    const V along = hn::Mul(shear, Dot3(h[a], h[b]));
    for (int k = 0; k < 3; ++k) {
      const V scaled = hn::Mul(growth, f[b][k]);
      for (int i = 0; i < 3; ++i) {
        V& entry = K[pair][3 * k + i];
        entry = hn::MulAdd(scaled, f[a][i], entry);
        if (i == k) entry = hn::Add(entry, along);
      }
    }
  }
  AddVolume(s, lambda, BoundedPressure(s, hn::Mul(lambda, hn::Sub(s.J, n.alpha)), least_curvature), h, K);
}

void TissueStiffness(const Blocks& e, const float* stretches, const double* x, double least_curvature, float* stiffness,
                     std::ptrdiff_t begin, std::ptrdiff_t end) {
  constexpr D d;
  constexpr std::size_t entries = 90;
  HWY_ALIGN float edges[edge_floats];
  for (std::ptrdiff_t b = begin; b < end; ++b) {
    GatherEdges(e, x, b, edges);
    for (std::size_t l = 0; l < Blocks::width; l += hn::Lanes(d)) {
      const std::ptrdiff_t slot = b * Blocks::width + static_cast<std::ptrdiff_t>(l);
      const State s(e, edges + 4 * l, slot);
      V h[4][3], K[10][9];
      HatGradients(s.D9, h);
      for (auto& block : K)
        for (V& entry : block) entry = hn::Zero(d);
      const V passive = hn::Sub(Number(1), s.active);
      V volume_weight = s.active, goal = s.active;  // sum of weights, and of weights times volume goals
      if (e.passive == PassiveLaw::corotated) {
        AddShape<false>(s, passive, nullptr, least_curvature, h, K);
        volume_weight = Number(1);
        goal = Number(1);
      } else {
        AddNeoHookeanStiffness(s, passive, least_curvature, h, K);
      }
      if (b < e.muscle_blocks) {
        V S[6];
        Load(stretches, slot, 6, S);
        AddShape<true>(s, s.active, S, least_curvature, h, K);
        goal = hn::MulAdd(s.active, hn::Sub(SymmetricDeterminant(S), Number(1)), goal);
      }
      const V twice = hn::Add(s.lambda, s.lambda);
      AddVolume(s, hn::Mul(twice, volume_weight),
                BoundedPressure(s, hn::Mul(twice, hn::MulSub(volume_weight, s.J, goal)), least_curvature), h, K);
      HWY_ALIGN float lanes[entries * Blocks::width];
      for (int pair = 0; pair < 10; ++pair)
        for (int k = 0; k < 9; ++k)
          hn::Store(hn::Mul(s.volume, K[pair][k]), d, lanes + static_cast<std::size_t>(9 * pair + k) * Blocks::width);
      float* out = stiffness + slot * static_cast<std::ptrdiff_t>(entries);
      for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane, out += entries)
        for (std::size_t k = 0; k < entries; ++k) out[k] = lanes[k * Blocks::width + lane];
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace phiz
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <algorithm>
#include <array>
#include <tuple>

namespace phiz {

HWY_EXPORT(EvaluateTissue);
HWY_EXPORT(TissueStiffness);

namespace {

/// Tets in the order of their slots: those with muscle, then the others, each kind by the rows of their corners and
/// filled with copies, -1 - tet, up to whole blocks.
std::vector<Eigen::Index> slot_order(const TissueBody& body, const VectorXi& row_of, std::ptrdiff_t* muscle_blocks) {
  std::vector<Eigen::Index> muscle, rest;
  for (Eigen::Index t = 0; t < body.tets.rows(); ++t)
    (body.active.size() > 0 && body.active[t] > 0 ? muscle : rest).push_back(t);
  const auto rows = [&](Eigen::Index t) {
    std::array<int, 4> r{};
    for (int c = 0; c < 4; ++c) r[static_cast<std::size_t>(c)] = row_of[body.tets(t, c)];
    std::sort(r.begin(), r.end());
    return r;
  };
  for (std::vector<Eigen::Index>* list : {&muscle, &rest}) {
    std::sort(list->begin(), list->end(), [&](Eigen::Index a, Eigen::Index b) {
      return std::make_tuple(rows(a), a) < std::make_tuple(rows(b), b);
    });
    while (list->size() % TissueBlocks::width != 0) list->push_back(-1 - list->front());
  }
  *muscle_blocks = static_cast<std::ptrdiff_t>(muscle.size()) / TissueBlocks::width;
  muscle.insert(muscle.end(), rest.begin(), rest.end());
  return muscle;
}

}  // namespace

TissueBlocks::TissueBlocks(const TissueBody& body, const VectorXi& row_of)
    : tets(body.tets.rows()), passive(body.passive), slot_of(body.tets.rows()) {
  const std::vector<Eigen::Index> order = slot_order(body, row_of, &muscle_blocks);
  const std::size_t count = order.size();
  blocks = static_cast<std::ptrdiff_t>(count) / width;
  for (Array* array : {&volume, &mu, &lambda, &active}) *array = hwy::AllocateAligned<float>(count);
  inverse = hwy::AllocateAligned<float>(9 * count);
  stretch = hwy::AllocateAligned<float>(6 * count);
  vertex = hwy::AllocateAligned<std::int32_t>(4 * count);
  const TetRest shape = tet_rest(body.rest, body.tets);
  for (std::size_t s = 0; s < count; ++s) {
    const auto slot = static_cast<std::ptrdiff_t>(s);
    const bool copy = order[s] < 0;
    const Eigen::Index t = copy ? -1 - order[s] : order[s];
    if (!copy) slot_of[t] = static_cast<int>(slot);
    const double growth = body.growth.size() > 0 ? body.growth[t] : 1;
    for (int k = 0; k < 9; ++k)
      inverse[at(slot, 9, k)] = static_cast<float>(shape.inverse_edges[static_cast<std::size_t>(t)].data()[k] / growth);
    volume[s] = copy ? 0 : static_cast<float>(shape.volume[t]);
    mu[s] = static_cast<float>(body.moduli[static_cast<std::size_t>(t)].mu);
    lambda[s] = static_cast<float>(body.moduli[static_cast<std::size_t>(t)].lambda);
    active[s] = body.active.size() > 0 ? static_cast<float>(body.active[t]) : 0;
    for (int k = 0; k < 6; ++k) stretch[at(slot, 6, k)] = k < 3 ? 1 : 0;
    for (int c = 0; c < 4; ++c) vertex[4 * s + static_cast<std::size_t>(c)] = row_of[body.tets(t, c)];
  }
  local.resize(4 * count);
  chunk_start.push_back(0);
  for (std::size_t first = 0; first < 4 * count; first += 4 * chunk * width) {
    const std::size_t last = std::min(4 * count, first + 4 * chunk * width);
    std::vector<int> rows(vertex.get() + first, vertex.get() + last);
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    for (std::size_t i = first; i < last; ++i)
      local[i] = static_cast<std::uint16_t>(std::lower_bound(rows.begin(), rows.end(), vertex[i]) - rows.begin());
    chunk_rows.insert(chunk_rows.end(), rows.begin(), rows.end());
    chunk_start.push_back(static_cast<int>(chunk_rows.size()));
  }
}

void TissueBlocks::set_stretch(std::ptrdiff_t tet, const Matrix3d& S) {
  const std::ptrdiff_t slot = slot_of[tet];
  const Vector6d a = activation_of(S);
  for (int k = 0; k < 6; ++k) stretch[at(slot, 6, k)] = static_cast<float>(a[k]);
}

double evaluate_tissue(const TissueBlocks& blocks, const double* x, std::ptrdiff_t chunk, float* sums) {
  std::fill_n(sums,
              4 * (blocks.chunk_start[static_cast<std::size_t>(chunk) + 1] -
                   blocks.chunk_start[static_cast<std::size_t>(chunk)]),
              0.0F);
  return HWY_DYNAMIC_DISPATCH(EvaluateTissue)(blocks, x, chunk, sums);
}

void tissue_stiffness(const TissueBlocks& blocks, const float* stretches, const double* x, double least_curvature,
                      float* stiffness, std::ptrdiff_t begin, std::ptrdiff_t end) {
  HWY_DYNAMIC_DISPATCH(TissueStiffness)(blocks, stretches, x, least_curvature, stiffness, begin, end);
}

}  // namespace phiz
#endif
