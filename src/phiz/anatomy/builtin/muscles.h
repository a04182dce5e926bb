// SPDX-License-Identifier: GPL-3.0-or-later
/// The muscles of facial expression (phace.md section 3: fifteen pairs, procerus, orbicularis oris, depressor septi)
/// and the two great closers of the jaw, as bundles of fibres that follow a person's proportions.
#pragma once

#include <string>
#include <vector>

#include "phiz/anatomy/builtin/proportions.h"
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
std::vector<MuscleBundle> make_muscles(const Proportions& proportions);

/// Moves every fibre point between the bone (carried vertices) and the skin of `head`, at the depth that the bundle
/// states, not deeper than 14 mm, and smooths the fibres. Uses head.volume, head.carrier, head.skin_triangles.
void settle_muscles(std::vector<MuscleBundle>& muscles, const HeadTemplate& head);

/// Fills head.muscles: fibres, and per flesh tet the share that lies within `radius` of a fibre and the unit direction
/// of the nearest fibre, by sampling each tet at fixed points. Where muscles overlap the shares are scaled so that
/// their sum stays at most 1.
void assign_muscles(HeadTemplate& head, const std::vector<MuscleBundle>& muscles);

}  // namespace phiz
