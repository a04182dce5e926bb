// SPDX-License-Identifier: GPL-3.0-or-later
/// The teeth of one half of an arch: their forms, and where along the arch they stand.
#pragma once

#include <array>
#include <span>

#include "phiz/anatomy/builtin/mouth/dental_arch.h"

namespace phiz {

/// A hill of the biting surface. (u, v): -1 mesial to 1 distal, -1 lingual to 1 labial; height 1 reaches the edge.
struct Cusp {
  double u, v, height;
};

/// A crown. Lengths in millimetres of a mean adult; shares are of the crown's own measures.
struct ToothForm {
  double width, thickness, height;        ///< along the arch, across it, from the gum to the edge
  double short_by;                        ///< how far the edge stays behind that of the central incisor
  double neck_width, neck_thickness;      ///< shares
  double mesial_contact, distal_contact;  ///< height at which it is widest, shares
  double mesial_edge, distal_edge;        ///< what is left of the half width at the edge, shares
  double roundness;                       ///< 3 square corner between side and edge, 1 straight slope
  double edge_thickness;                  ///< share that is left at the edge, or at the rim of the biting surface
  double labial_fall;                     ///< from the labial face's height of contour back to the edge
  double lean;                            ///< slope: positive leans the neck inwards, negative the edge
  double squareness;                      ///< exponent of the cross-section's outline
  std::span<const Cusp> cusps{};          ///< none: an edge
};
using HalfDentition = std::array<ToothForm, 7>;  ///< central incisor to second molar

const HalfDentition& upper_dentition();
const HalfDentition& lower_dentition();

/// Where a tooth stands: arc lengths of its borders and its middle on the labial outline, and its width, metres.
struct ToothPlace {
  double mesial, middle, distal, width;
};

/// Neighbouring crowns touch `contact_depth` inside of the labial outline. The widths are scaled to fill the arch.
std::array<ToothPlace, 7> tooth_places(const ArchCurve& arch, const HalfDentition& teeth);
inline constexpr double contact_depth = 0.0022;  ///< metres

/// How far the labial face lies inside of the labial outline at `share` of the crown's height, metres, before the
/// scaling to the arch.
double labial_depth(const ToothForm& tooth, double share);

}  // namespace phiz
