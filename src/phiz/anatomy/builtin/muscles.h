// SPDX-License-Identifier: GPL-3.0-or-later
/// The muscles of facial expression (phace.md section 3: fifteen pairs, procerus, orbicularis oris, depressor septi)
/// and the two great closers of the jaw, as bundles of fibres that follow a person's proportions.
#pragma once

#include <string>
#include <vector>

#include "phiz/anatomy/builtin/proportions.h"
#include "phiz/anatomy/fibre_field.h"
#include "phiz/anatomy/head_template.h"

namespace phiz {

/// A muscle as a bundle of fibres. Its tissue is everything within `radius` of a fibre, so that a row of fibres is a
/// sheet, one fibre is a spindle, closed fibres are a ring.
struct MuscleBundle {
  std::string name;               ///< e.g. "zygomaticusMajorLeft", "procerus"
  std::vector<MatrixX3d> fibres;  ///< polylines from origin to insertion, metres; closed ones repeat the first point
  double radius = 0.002;          ///< half the thickness, metres
  double origin_depth = 0.15;     ///< where the origin lies between bone (0) and skin (1)
  double insertion_depth = 0.75;  ///< where the insertion lies
  bool placed = false;            ///< its points lie where they belong: settle_muscles leaves them
};

/// The point of a fibre that is nearest to p.
struct FibrePoint {
  Eigen::Index piece = 0;       ///< between points `piece` and `piece` + 1
  double share = 0;             ///< of the way from the first to the second
  double squared_distance = 0;  ///< to p, square metres
};
/// `fibre`: a polyline of at least two points.
FibrePoint nearest_on_fibre(const MatrixX3d& fibre, const Vector3d& p);

/// All muscles, left before right, in a fixed order: 33 of expression, then masseter and temporalis. Exactly mirrored.
/// The points lie near the skin that the proportions describe; settle_muscles puts them into a particular head.
std::vector<MuscleBundle> make_muscle_bundles(const Proportions& proportions);

/// Moves every fibre point between the bone (carried vertices) and the skin of `head`, at the depth that the bundle
/// states, not deeper than 14 mm, and smooths the fibres. Uses head.volume, head.carrier, head.skin_triangles.
void settle_muscles(std::vector<MuscleBundle>& muscles, const HeadTemplate& head);

/// The bundles as closed surfaces: tubes of the bundle's radius round its fibres, and round as many between these as
/// make a sheet, moved so that they have room between the skin (inner skin too) and the bones; thinner where there is
/// less. Origin and insertion are the ends of the fibres; right ones are mirror images. Uses head.volume and
/// head.skin_triangles.
std::vector<MuscleShape> muscle_shapes(const std::vector<MuscleBundle>& bundles, const HeadTemplate& head);

}  // namespace phiz
