// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <limits>

#include "phiz/geometry/tet_operations.h"

namespace phiz {

namespace {

struct Wall {
  int tet, corner;
  double quality;  ///< of the tet between it and the new vertex
};

/// Tets to be replaced by ones that join a vertex with their outer faces.
class Cavity {
 public:
  Cavity(const TetComplex& complex, int centre) : complex_(complex), centre_(centre) {}

  void add(int t) {
    tets_.push_back(t);
    walls_.erase(std::remove_if(walls_.begin(), walls_.end(),
                                [&](const Wall& w) { return complex_.across(w.tet, w.corner) == t; }),
                 walls_.end());
    for (int k = 0; k < 4; ++k) {
      const int other = complex_.across(t, k);
      if (other >= 0 && contains(other)) continue;
      walls_.push_back({t, k, complex_.quality(joined({t, k, 0}))});
    }
  }

  bool contains(int t) const { return std::find(tets_.begin(), tets_.end(), t) != tets_.end(); }
  const std::vector<int>& tets() const { return tets_; }
  const std::vector<Wall>& walls() const { return walls_; }

  const Wall& worst() const {
    return *std::min_element(walls_.begin(), walls_.end(),
                             [](const Wall& a, const Wall& b) { return a.quality < b.quality; });
  }

  Corners joined(const Wall& wall) const {
    const Corners& v = complex_.tet(wall.tet).v;
    // Faces are outward: the new vertex is on their inner side.
    return {centre_, v[static_cast<std::size_t>(face_corners[wall.corner][0])],
            v[static_cast<std::size_t>(face_corners[wall.corner][1])],
            v[static_cast<std::size_t>(face_corners[wall.corner][2])]};
  }

 private:
  const TetComplex& complex_;
  int centre_;
  std::vector<int> tets_;
  std::vector<Wall> walls_;
};

/// Fills the best cavity round the new vertex that starts as tet t. Returns whether there was a valid one.
bool fill_cavity(TetComplex& complex, int centre, std::span<const int> start) {
  constexpr std::size_t most_tets = 40;
  Cavity cavity(complex, centre);
  for (const int t : start) cavity.add(t);
  double best = 0;
  std::size_t best_size = 0;
  for (;;) {
    const Wall worst = cavity.worst();
    if (worst.quality > best) {
      best = worst.quality;
      best_size = cavity.tets().size();
    }
    const int next = complex.across(worst.tet, worst.corner);
    if (next < 0 || cavity.tets().size() == most_tets) break;
    cavity.add(next);
  }
  if (best_size == 0) return false;
  Cavity kept(complex, centre);
  for (std::size_t i = 0; i < best_size; ++i) kept.add(cavity.tets()[i]);
  std::vector<Corners> fresh;
  for (const Wall& wall : kept.walls()) fresh.push_back(kept.joined(wall));
  complex.exchange(kept.tets(), fresh);
  return true;
}

/// Smooths the vertex and its neighbours and flips the tets round it.
void improve_round(TetComplex& complex, int v) {
  for (int round = 0; round < 2; ++round) {
    bool changed = smooth_vertex(complex, v);
    const std::vector<int> tets = complex.tets_of(v);
    for (const int t : tets) {
      if (!complex.tet(t).alive) continue;
      const Corners corners = complex.tet(t).v;
      for (const int other : corners)
        if (other != v) changed = smooth_vertex(complex, other) || changed;
      for (int i = 0; i < 4 && complex.tet(t).alive; ++i)
        for (int j = i + 1; j < 4 && complex.tet(t).alive; ++j)
          changed = remove_edge(complex, corners[static_cast<std::size_t>(i)], corners[static_cast<std::size_t>(j)]) ||
                    changed;
      for (int k = 0; k < 4 && complex.tet(t).alive; ++k) changed = remove_faces(complex, t, k) || changed;
    }
    if (!changed) break;
  }
}

}  // namespace

bool contract_edge(TetComplex& complex, int inner, int into) {
  if (complex.on_surface(inner)) return false;
  const std::vector<int> old = complex.tets_of(inner);
  const double before = complex.worst(old);
  std::vector<Corners> fresh;
  bool joined = false;
  for (const int t : old) {
    Corners v = complex.tet(t).v;
    if (corner_of(v, into) >= 0) {
      joined = true;
      continue;
    }
    v[static_cast<std::size_t>(corner_of(v, inner))] = into;
    if (!(complex.quality(v) > before + least_gain)) return false;
    fresh.push_back(v);
  }
  if (!joined || fresh.empty()) return false;
  complex.exchange(old, fresh);
  return true;
}

bool insert_vertex(TetComplex& complex, int t) {
  const Corners v = complex.tet(t).v;
  const auto corner = [&](int k) -> const Vector3d& { return complex.x(v[static_cast<std::size_t>(k)]); };
  struct Place {
    Vector3d at;
    std::vector<int> start;
  };
  std::vector<Place> places{{0.25 * (corner(0) + corner(1) + corner(2) + corner(3)), {t}}};
  for (int k = 0; k < 4; ++k) {
    const int other = complex.across(t, k);
    if (other < 0) continue;
    const auto& f = face_corners[k];
    places.push_back({(corner(f[0]) + corner(f[1]) + corner(f[2])) / 3, {t, other}});
  }
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j) {
      const int a = v[static_cast<std::size_t>(i)], b = v[static_cast<std::size_t>(j)];
      const std::vector<int> round = complex.tets_of_edge(a, b);
      // Only edges inside of a region: closed rings.
      bool inside = true;
      for (const int r : round)
        for (int k = 0; k < 4 && inside; ++k) {
          const int c = complex.tet(r).v[static_cast<std::size_t>(k)];
          if (c != a && c != b) inside = complex.across(r, k) >= 0;
        }
      if (inside) places.push_back({0.5 * (corner(i) + corner(j)), round});
    }
  for (const Place& place : places) {
    const std::size_t mark = complex.mark();
    const int centre = complex.add_vertex(place.at);
    if (fill_cavity(complex, centre, place.start)) {
      improve_round(complex, centre);
      if (complex.is_better_since(mark, 10 * least_gain)) return true;
    }
    complex.take_back(mark);
  }
  return false;
}

}  // namespace phiz
