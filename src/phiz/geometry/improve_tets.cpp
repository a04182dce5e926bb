// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/geometry/improve_tets.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "phiz/core/error.h"
#include "phiz/geometry/tet_operations.h"
#include "phiz/geometry/validate.h"

namespace phiz {

namespace {

double degrees(double sine) {
  return std::asin(std::clamp(sine, -1.0, 1.0)) * 180 / std::numbers::pi;
}

double sine(double angle) {
  return std::sin(angle * std::numbers::pi / 180);
}

/// Tets of lower quality than `target`, the worst first.
std::vector<int> poor_tets(const TetComplex& complex, double target) {
  std::vector<int> poor;
  for (int t = 0; t < complex.tets(); ++t)
    if (complex.tet(t).alive && complex.tet(t).quality < target) poor.push_back(t);
  std::stable_sort(poor.begin(), poor.end(),
                   [&](int a, int b) { return complex.tet(a).quality < complex.tet(b).quality; });
  return poor;
}

double worst_of(const TetComplex& complex) {
  double worst = 1;
  for (int t = 0; t < complex.tets(); ++t)
    if (complex.tet(t).alive) worst = std::min(worst, complex.tet(t).quality);
  return worst;
}

/// What is tried on one poor tet, the cheap things first, until it is gone or good.
class TetDoctor {
 public:
  TetDoctor(TetComplex& complex, double target, ImproveSummary& summary)
      : complex_(complex), target_(target), summary_(summary) {}

  bool treat(int t, bool insert) {
    bool changed = smooth(t);
    if (!is_poor(t)) return changed;
    if (flip(t) || contract(t)) return true;
    if (insert && insert_vertex(complex_, t)) {
      ++summary_.insertions;
      return true;
    }
    return changed;
  }

 private:
  bool is_poor(int t) const { return complex_.tet(t).alive && complex_.tet(t).quality < target_; }

  bool smooth(int t) {
    bool changed = false;
    for (const int v : complex_.tet(t).v)
      if (smooth_vertex(complex_, v)) {
        ++summary_.moves;
        changed = true;
      }
    return changed;
  }

  bool flip(int t) {
    const Corners v = complex_.tet(t).v;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j)
        if (remove_edge(complex_, v[i], v[j])) return ++summary_.flips, true;
    for (int k = 0; k < 4; ++k)
      if (remove_faces(complex_, t, k)) return ++summary_.flips, true;
    return false;
  }

  bool contract(int t) {
    const Corners v = complex_.tet(t).v;
    for (const int from : v)
      for (const int into : v)
        if (from != into && contract_edge(complex_, from, into)) return ++summary_.contractions, true;
    return false;
  }

  TetComplex& complex_;
  double target_;
  ImproveSummary& summary_;
};

int count_below(const TetComplex& complex, double target) {
  return static_cast<int>(poor_tets(complex, target).size());
}

/// How much is wrong: the sum of target / quality - 1 over the tets below the target. The worst count most.
double badness(const TetComplex& complex, double target) {
  double sum = 0;
  for (const int t : poor_tets(complex, target)) sum += target / complex.tet(t).quality - 1;
  return sum;
}

/// Passes over the poor tets. Where nothing can help, insertions may leave several poor tets for one: the best state
/// is kept.
void work(TetComplex& complex, double target, double insert_below, int passes, ImproveSummary& summary) {
  constexpr int patience = 4;  // passes that gain less than a hundredth
  TetDoctor doctor(complex, target, summary);
  TetComplex best = complex;
  double least = badness(complex, insert_below);
  for (int pass = 0, wait = 0; pass < passes && wait < patience; ++pass, ++summary.passes) {
    const bool insert = pass > 1;  // the cheap means first
    bool changed = false;
    for (const int t : poor_tets(complex, target)) {
      if (!complex.tet(t).alive || !(complex.tet(t).quality < target)) continue;
      changed = doctor.treat(t, insert && complex.tet(t).quality < insert_below) || changed;
      complex.settle();
    }
    const double left = badness(complex, insert_below);
    wait = left == 0 || left < 0.99 * least ? 0 : wait + 1;
    if (left <= least) {
      least = left;
      best = complex;
    }
    if (!changed && insert) break;
  }
  complex = std::move(best);
}

void check_options(const TetMesh& mesh, const ImproveOptions& options) {
  if (!(options.target >= 0 && options.target < 60) || !(options.insert_below >= 0) || options.passes < 0)
    throw Error(ErrorKind::usage,
                "the target must lie between 0 and 60 degrees, insert_below and passes must not be negative");
  if (options.give.size() > 0 && (options.give.size() != mesh.V.rows() || !(options.give.minCoeff() >= 0)))
    throw Error(ErrorKind::usage, "give must hold one number for each vertex, none negative");
}

}  // namespace

ImproveSummary improve_tets(TetMesh& mesh, const ImproveOptions& options) {
  check_options(mesh, options);
  validate(mesh, "improve_tets");
  TetComplex complex(mesh, options.give);
  int surface = 0;
  while (surface < complex.vertices() && complex.on_surface(surface)) ++surface;
  for (int v = surface; v < complex.vertices(); ++v)
    if (complex.on_surface(v))
      throw Error(ErrorKind::bad_input, fmt::format("improve_tets: vertex {} lies on a surface but {} does not; the "
                                                    "vertices of surfaces must come first",
                                                    v, surface));
  const double target = sine(options.target), insert_below = sine(std::min(options.insert_below, options.target));
  ImproveSummary summary;
  summary.below_before = count_below(complex, target);
  summary.worst_before = degrees(worst_of(complex));
  // First round shapes, then the angles that those do not cover; angles alone where that made the worst one worse.
  constexpr double splinter_weight = 3;
  const double worst = worst_of(complex);
  const TetComplex start = complex;
  complex.measure_with(splinter_weight);
  work(complex, target, insert_below, options.passes, summary);
  complex.measure_with(angles_only);
  work(complex, insert_below, insert_below, options.passes, summary);
  if (worst_of(complex) < worst) {
    complex = start;
    work(complex, target, insert_below, options.passes, summary);
  }
  summary.below_after = count_below(complex, target);
  summary.worst_after = degrees(worst_of(complex));
  for (int v = 0; v < surface; ++v)
    summary.largest_surface_move = std::max(summary.largest_surface_move, complex.moved_by(v));
  mesh = complex.mesh();
  return summary;
}

double smooth_tets(TetMesh& mesh, const ImproveOptions& options) {
  check_options(mesh, options);
  TetComplex complex(mesh, options.give);
  const double target = sine(options.target);
  bool changed = true;
  for (int pass = 0; pass < options.passes && changed; ++pass) {
    changed = false;
    for (const int t : poor_tets(complex, target))
      for (const int v : complex.tet(t).v) changed = smooth_vertex(complex, v) || changed;
    complex.settle();
  }
  for (int v = 0; v < complex.vertices(); ++v) mesh.V.row(v) = complex.x(v);
  return degrees(worst_of(complex));
}

std::string brief_report(const ImproveSummary& s) {
  return fmt::format(
      "worst angle {:.1f} to {:.1f} degrees, tets below the target {} to {} ({} passes, {} moves, {} flips, {} "
      "contractions, {} insertions, surfaces moved by up to {:.2f} mm)",
      s.worst_before, s.worst_after, s.below_before, s.below_after, s.passes, s.moves, s.flips, s.contractions,
      s.insertions, 1e3 * s.largest_surface_move);
}

}  // namespace phiz
