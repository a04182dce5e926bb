// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/mouth/crown.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "phiz/anatomy/builtin/mouth/loft.h"

namespace phiz {
namespace {

constexpr int sectors = 28;
constexpr double labial_share = 0.42;  ///< of the thickness that lies in front of the widest place
constexpr std::array wall_levels{-0.55, -0.28, -0.08, 0.0, 0.08, 0.18, 0.30, 0.44, 0.58, 0.71, 0.82, 0.91, 0.965, 1.0};
constexpr std::array table_rings{0.90, 0.76, 0.60, 0.44, 0.28, 0.12};

/// Half width at a height, as a share of the greatest: from the neck out to the contact, then in to the edge.
double side(double height, double neck, double contact, double edge, double roundness) {
  if (height <= 0) return neck * (1 + 0.3 * height);
  if (height < contact) return neck + (1 - neck) * std::sin(0.5 * std::numbers::pi * height / contact);
  return edge + (1 - edge) * (1 - std::pow((height - contact) / (1 - contact), roundness));
}

/// Thickness at a height, as a share of the greatest: a bulge over the neck, then hollow towards an edge, or straight
/// up to the biting surface of a grinder.
double thickness_at(const ToothForm& form, double height) {
  constexpr double bulge = 0.22;
  if (height <= 0) return form.neck_thickness * (1 + 0.3 * height);
  if (height < bulge)
    return form.neck_thickness + (1 - form.neck_thickness) * std::sin(0.5 * std::numbers::pi * height / bulge);
  const double t = (height - bulge) / (1 - bulge);
  const double left = form.cusps.empty() ? std::pow(1 - t, 1.7) : 1 - t * t;
  return form.edge_thickness + (1 - form.edge_thickness) * left;
}

/// Height of the biting surface, as a share of the crown's: hills that meet in grooves.
double table_height(const ToothForm& form, double u, double v) {
  constexpr double sharpness = 16, slope = 0.30;
  double sum = 0;
  for (const Cusp& c : form.cusps)
    sum += std::exp(sharpness * (c.height - slope * std::sqrt(std::pow(u - c.u, 2) + std::pow(v - c.v, 2) + 0.015)));
  // The ridges at both ends of the table.
  for (const double end : {-0.92, 0.92})
    sum += std::exp(sharpness * (0.86 - slope * std::hypot(1.6 * (u - end), 0.35 * v)));
  return std::log(sum) / sharpness;
}

}  // namespace

TriangleMesh make_crown(const ToothForm& form, double width, double thickness, double height) {
  const bool grinder = !form.cusps.empty();
  const double scale = height / (1e-3 * form.height);
  double top = 1;  // of the biting surface, which is brought to the height of the edge
  if (grinder) {
    top = 0;
    for (const Cusp& c : form.cusps) top = std::max(top, table_height(form, c.u, c.v));
  }
  // A point at `level` of the wall, or inside of the biting surface at `ring` of its outline.
  const auto place = [&](double level, double ring, double angle) -> Vector3d {
    const double c = std::cos(angle), s = std::sin(angle), e = 2 / form.squareness;
    const double along = std::copysign(std::pow(std::abs(c), e), c),
                 across = std::copysign(std::pow(std::abs(s), e), s);
    const double half = 0.5 * width *
                        (c > 0 ? side(level, form.neck_width, form.distal_contact, form.distal_edge, form.roundness)
                               : side(level, form.neck_width, form.mesial_contact, form.mesial_edge, form.roundness));
    const double depth = thickness * thickness_at(form, level), labial = -scale * labial_depth(form, level);
    const double widest = labial - labial_share * depth;
    // Crowns taper inwards, as the arch does.
    const double taper = across < 0 ? 1 + (grinder ? 0.10 : 0.26) * across : 1;
    const double x = ring * half * along * taper;
    const double z = widest + ring * depth * across * (across > 0 ? labial_share : 1 - labial_share);
    double y = level;
    if (grinder) {
      const double rim = table_height(form, ring * along, ring * across) / top;
      y = level > 0 ? level * rim : level;
    }
    // The neck follows the gum: it dips between the teeth.
    y += 0.12 * std::exp(-std::pow(level / 0.25, 2)) * (along * along - 0.5);
    if (!grinder && level > 0.9) {  // the edge is convex seen from the front, and rounded across
      y -= 0.012 * along * along * (level - 0.9) / 0.1;
    }
    return {x, height * y, z};
  };
  std::vector<MatrixX3d> rings;
  const auto add = [&](double level, double ring) {
    MatrixX3d points(sectors, 3);
    for (int i = 0; i < sectors; ++i)
      points.row(i) = place(level, ring, 2 * std::numbers::pi * i / sectors).transpose();
    rings.push_back(points);
  };
  for (const double level : wall_levels) add(level, 1);
  if (grinder)
    for (const double ring : table_rings) add(1, ring);
  return loft(rings);
}

}  // namespace phiz
