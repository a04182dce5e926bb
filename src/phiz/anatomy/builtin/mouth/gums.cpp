// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "phiz/anatomy/builtin/ease.h"
#include "phiz/anatomy/builtin/mouth/dentition.h"
#include "phiz/anatomy/builtin/mouth/loft.h"
#include "phiz/anatomy/builtin/mouth/teeth.h"

namespace phiz {
namespace {

constexpr int labial_points = 14, ridge_points = 4, lingual_points = 10;
constexpr int half_stations = 110;
constexpr double papilla_share = 0.56;  ///< of the crown's height that the gum fills between two teeth
constexpr double behind = 0.004;        ///< that the gum goes on behind the last molar, metres

/// The gum at one place of the arch, metres.
struct Margin {
  double height;     ///< of the margin over the neck of the central incisor, towards the edge
  double depth;      ///< of the tooth's neck inside of the labial outline
  double thickness;  ///< of the tooth across the arch
  double papilla;    ///< 0 at the middle of a crown, 1 between two
};

Margin margin_at(double s, const HalfDentition& teeth, const std::array<ToothPlace, 7>& places, double tall) {
  const double mm = 1e-3;
  const auto neck = [&](std::size_t i) {  // over that of the central incisor
    return mm * (tall * (teeth[0].height - teeth[i].height) - teeth[i].short_by);
  };
  std::size_t i = 0;
  while (i + 1 < places.size() && s > places[i].distal) ++i;
  const bool distal = s > places[i].middle;
  const std::size_t next = distal ? std::min(i + 1, places.size() - 1) : i == 0 ? 0 : i - 1;
  const double half = distal ? places[i].distal - places[i].middle : places[i].middle - places[i].mesial;
  const double from_middle = std::min(1.0, std::abs(s - places[i].middle) / half);
  const double papilla = std::pow(from_middle, 2.0);
  const double tip =
      0.5 * (neck(i) + neck(next)) + papilla_share * mm * tall * 0.5 * (teeth[i].height + teeth[next].height);
  const double t = 0.5 * from_middle * from_middle;  // the half way to the neighbour
  const auto mix = [&](double own, double other) { return (1 - t) * own + t * other; };
  Margin m{neck(i) + papilla * (tip - neck(i)), mix(labial_depth(teeth[i], 0.05), labial_depth(teeth[next], 0.05)),
           mm * mix(teeth[i].thickness, teeth[next].thickness), papilla};
  if (i + 1 == places.size() && distal) {  // behind the last molar the gum is a low pad
    m.height -= papilla * (tip - neck(i)) * 0.7;
    m.papilla *= 0.3;
  }
  return m;
}

/// The band from the sulcus to the necks. `sulcus`: y of the hidden side.
TriangleMesh make_gums(const ArchCurve& arch, const HalfDentition& teeth, double gum, double edge, double sulcus) {
  const auto places = tooth_places(arch, teeth);
  const double up = edge > gum ? 1.0 : -1.0, tall = std::abs(edge - gum) / (1e-3 * teeth[0].height);
  const double end = arch.length() + behind;
  std::vector<MatrixX3d> rings;
  for (int k = -half_stations; k <= half_stations; ++k) {
    const double side = k < 0 ? -1 : 1, s = end * std::abs(k) / half_stations;
    const Margin m = margin_at(s, teeth, places, tall);
    const double bottom = -std::abs(sulcus - gum) - 0.002;
    const double closing = std::sqrt(std::max(0.02, 1 - std::pow(std::max(0.0, (s - end + 0.005) / 0.005), 2)));
    // Cross-section as (depth inside of the labial outline, height over the central incisor's neck).
    std::vector<Vector2d> section;
    const double back = m.depth + 0.92 * m.thickness + 0.0013;
    for (int i = 0; i < labial_points; ++i) {
      const double t = i / double(labial_points - 1), y = bottom + (m.height - bottom) * (1 - std::pow(1 - t, 1.35));
      const double below = m.height - y;
      // The attached gum follows the roots; at the margin it rolls in to the neck, between the teeth more.
      const double root = 0.0002 + 0.00025 * m.papilla * std::exp(-std::pow((below - 0.005) / 0.006, 2));
      const double rolled = std::exp(-below / 0.0009);
      const double at_margin = std::max(m.depth - 0.00045, 0.0002) + 0.00045 * m.papilla;
      const double near = std::exp(-std::pow(below / 0.0042, 2));
      section.emplace_back(root + near * (at_margin - root) + 0.0004 * rolled, y);
    }
    const double from = section.back().x();
    for (int i = 1; i <= ridge_points; ++i) {
      const double t = i / double(ridge_points + 1);
      section.emplace_back(from + t * (back - from), m.height - 0.0011 * m.papilla * std::sin(std::numbers::pi * t));
    }
    for (int i = 0; i < lingual_points; ++i) {
      const double t = i / double(lingual_points - 1);
      section.emplace_back(back + 0.0010 * smoothstep(0, 0.25, t), m.height + (bottom - m.height) * std::pow(t, 1.35));
    }
    Vector2d middle = Vector2d::Zero();
    for (const Vector2d& q : section) middle += q / static_cast<double>(section.size());
    const Vector2d outward = arch.outward(s), base = arch.point(s);
    MatrixX3d ring(static_cast<Eigen::Index>(section.size()), 3);
    for (std::size_t i = 0; i < section.size(); ++i) {
      const Vector2d q = middle + Vector2d(closing, 0.6 + 0.4 * closing).cwiseProduct(section[i] - middle);
      const Vector2d plane = base - q.x() * outward;
      ring.row(static_cast<Eigen::Index>(i)) << side * plane.x(), gum + up * q.y(), plane.y();
    }
    if (k == 0) ring.col(0).setZero();
    rings.push_back(ring);
  }
  return loft(rings);
}

}  // namespace

TriangleMesh make_upper_gums(const Proportions& p) {
  return make_gums(upper_arch(p.arch), upper_dentition(), p.arch.upper_gum, p.arch.upper_edge, p.arch.upper_sulcus);
}

TriangleMesh make_lower_gums(const Proportions& p) {
  return make_gums(lower_arch(p.arch), lower_dentition(), p.arch.lower_gum, p.arch.lower_edge, p.arch.lower_sulcus);
}

}  // namespace phiz
