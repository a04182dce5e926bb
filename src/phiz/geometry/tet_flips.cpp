// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <limits>

#include "phiz/geometry/tet_operations.h"

namespace phiz {

namespace {

constexpr int largest_ring = 14;

/// The other vertices of the tets round an edge, counter-clockwise seen from b; empty unless they close inside of one
/// region.
std::vector<int> ring_of(const TetComplex& complex, int a, int b, const std::vector<int>& tets) {
  const int n = static_cast<int>(tets.size());
  if (n < 3 || n > largest_ring) return {};
  std::vector<std::array<int, 2>> arcs;
  for (const int t : tets) {
    if (complex.tet(t).region != complex.tet(tets[0]).region) return {};
    const Corners& v = complex.tet(t).v;
    const int i = corner_of(v, a), j = corner_of(v, b);
    int rest[2], count = 0;
    for (int k = 0; k < 4; ++k)
      if (k != i && k != j) rest[count++] = k;
    // (a, b, p, q) is positive when the permutation is even.
    const int order[4] = {i, j, rest[0], rest[1]};
    int swaps = 0;
    for (int p = 0; p < 4; ++p)
      for (int q = p + 1; q < 4; ++q) swaps += order[p] > order[q] ? 1 : 0;
    if (swaps % 2 != 0) std::swap(rest[0], rest[1]);
    arcs.push_back({v[static_cast<std::size_t>(rest[0])], v[static_cast<std::size_t>(rest[1])]});
  }
  std::vector<int> ring{arcs[0][0]};
  int at = arcs[0][1];
  while (at != ring[0]) {
    if (static_cast<int>(ring.size()) == n) return {};
    ring.push_back(at);
    const auto next = std::find_if(arcs.begin(), arcs.end(), [at](const auto& arc) { return arc[0] == at; });
    if (next == arcs.end()) return {};
    at = (*next)[1];
  }
  if (static_cast<int>(ring.size()) != n) return {};
  return ring;
}

/// Patch of faces between the apexes a (behind) and b (in front) that remove_faces removes.
struct Patch {
  int a, b;
  std::vector<int> tets;                ///< on both sides
  std::vector<std::array<int, 2>> rim;  ///< counter-clockwise seen from b
};

struct Found {
  int tet, corner;
};

/// The tet of the complex with these four vertices, and its corner `apex`.
Found find_tet(const TetComplex& complex, int apex, int p, int q, int r) {
  for (const int t : complex.tets_of(apex)) {
    const Corners& v = complex.tet(t).v;
    if (corner_of(v, p) >= 0 && corner_of(v, q) >= 0 && corner_of(v, r) >= 0) return {t, corner_of(v, apex)};
  }
  return {-1, -1};
}

/// Grows the patch over the edge (p, q) of its rim where that gives better tets; returns the worst new tet.
double grow(const TetComplex& complex, Patch& patch, int p, int q, int depth) {
  const double here = complex.quality({patch.a, patch.b, p, q});
  if (depth > 0) {
    // The face across (p, q) that lies between the same apexes.
    for (const int t : complex.tets_of_edge(p, q)) {
      if (std::find(patch.tets.begin(), patch.tets.end(), t) != patch.tets.end()) continue;
      const Corners& v = complex.tet(t).v;
      if (corner_of(v, patch.a) < 0 || complex.tet(t).region != complex.tet(patch.tets[0]).region) continue;
      int r = -1;
      for (const int c : v)
        if (c != p && c != q && c != patch.a) r = c;
      if (r == patch.b) continue;
      const Found front = find_tet(complex, patch.b, p, q, r);
      if (front.tet < 0 || complex.tet(front.tet).region != complex.tet(t).region) continue;
      if (std::find(patch.tets.begin(), patch.tets.end(), front.tet) != patch.tets.end()) continue;
      Patch trial = patch;
      trial.tets.insert(trial.tets.end(), {t, front.tet});
      const double with = std::min(grow(complex, trial, p, r, depth - 1), grow(complex, trial, r, q, depth - 1));
      if (with > here) {
        patch = std::move(trial);
        return with;
      }
    }
  }
  patch.rim.push_back({p, q});
  return here;
}

}  // namespace

bool remove_edge(TetComplex& complex, int a, int b) {
  const std::vector<int> tets = complex.tets_of_edge(a, b);
  const std::vector<int> ring = ring_of(complex, a, b, tets);
  if (ring.empty()) return false;
  const double before = complex.worst(tets);
  const int n = static_cast<int>(ring.size());
  double best[largest_ring][largest_ring];
  int middle[largest_ring][largest_ring];
  const auto vertex = [&ring](int i) { return ring[static_cast<std::size_t>(i)]; };
  for (int span = 1; span < n; ++span)
    for (int i = 0; i + span < n; ++i) {
      const int j = i + span;
      best[i][j] = span == 1 ? infinite : -infinite;
      for (int k = i + 1; k < j; ++k) {
        double q = std::min(best[i][k], best[k][j]);
        if (q > best[i][j]) q = std::min(q, complex.quality({vertex(i), vertex(k), vertex(j), b}));
        if (q > best[i][j]) q = std::min(q, complex.quality({a, vertex(i), vertex(k), vertex(j)}));
        if (q > best[i][j]) {
          best[i][j] = q;
          middle[i][j] = k;
        }
      }
      if (!(best[i][j] > before + least_gain)) best[i][j] = -infinite;
    }
  if (!(best[0][n - 1] > before + least_gain)) return false;
  std::vector<Corners> fresh;
  std::vector<std::array<int, 2>> open{{0, n - 1}};
  while (!open.empty()) {
    const auto [i, j] = open.back();
    open.pop_back();
    if (j - i < 2) continue;
    const int k = middle[i][j];
    fresh.push_back({vertex(i), vertex(k), vertex(j), b});
    fresh.push_back({a, vertex(i), vertex(k), vertex(j)});
    open.push_back({i, k});
    open.push_back({k, j});
  }
  complex.exchange(tets, fresh);
  return true;
}

bool remove_faces(TetComplex& complex, int t, int k) {
  const int other = complex.across(t, k);
  if (other < 0) return false;
  const Corners& v = complex.tet(t).v;
  Patch patch{v[static_cast<std::size_t>(k)], -1, {t, other}, {}};
  int f[3];
  for (int i = 0; i < 3; ++i) f[i] = v[static_cast<std::size_t>(face_corners[k][i])];
  for (const int c : complex.tet(other).v)
    if (c != f[0] && c != f[1] && c != f[2]) patch.b = c;
  double after = infinite;
  for (int i = 0; i < 3; ++i) after = std::min(after, grow(complex, patch, f[i], f[(i + 1) % 3], 3));
  if (!(after > complex.worst(patch.tets) + least_gain)) return false;
  // The new tets go once round the edge when every corner of the rim has one edge in and one out.
  std::vector<int> from, to;
  for (const auto& [p, q] : patch.rim) {
    from.push_back(p);
    to.push_back(q);
  }
  std::sort(from.begin(), from.end());
  std::sort(to.begin(), to.end());
  if (from != to || std::adjacent_find(from.begin(), from.end()) != from.end()) return false;
  std::vector<Corners> fresh;
  for (const auto& [p, q] : patch.rim) fresh.push_back({patch.a, patch.b, p, q});
  complex.exchange(patch.tets, fresh);
  return true;
}

}  // namespace phiz
