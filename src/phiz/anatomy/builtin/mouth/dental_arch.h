// SPDX-License-Identifier: GPL-3.0-or-later
/// The curve on which the teeth of one jaw stand.
#pragma once

#include "phiz/anatomy/builtin/proportions.h"

namespace phiz {

/// The left half of the labial outline of an arch, from the midline to the last molar, by arc length.
class ArchCurve {
 public:
  /// Half ellipse of the given half axes (metres) in the xz plane about (0, z0).
  ArchCurve(double half_width, double depth, double z0);

  double length() const { return length_; }
  /// The point at arc length s from the midline: x, z; s beyond the end goes straight back.
  Vector2d point(double s) const;
  /// Unit tangent towards the molars and unit outward normal, as (x, z).
  Vector2d tangent(double s) const;
  Vector2d outward(double s) const;

 private:
  double angle(double s) const;
  double half_width_, depth_, z0_, length_;
  VectorXd arc_;  ///< arc length at equally spaced angles
};

ArchCurve upper_arch(const Proportions::DentalArch& arch);
ArchCurve lower_arch(const Proportions::DentalArch& arch);

}  // namespace phiz
