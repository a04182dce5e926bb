// SPDX-License-Identifier: GPL-3.0-or-later
/// The lids of one eye: sheets that slide round the eyeball. The space in front of the eye is turned about the axis
/// through the canthi, each half plane by itself: the margins go where a motion says, what lies between them is pressed
/// together, and the skin between margin and brow unfolds. Since angles keep their order, lids and their lining do not
/// pass through one another.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "phiz/anatomy/builtin/expressions/flesh.h"
#include "phiz/anatomy/builtin/expressions/recipes.h"
#include "phiz/anatomy/head_template.h"

namespace phiz {

/// The front of an eyeball as a function of direction: a sphere with a cornea that bulges forward.
struct EyeShape {
  Vector3d centre = Vector3d::Zero();
  double radius = 0.012;
  double cornea_height = 0.0009;  ///< how far the apex stands out of the sphere, metres
  double cornea_angle = 0.5;      ///< half the opening angle of the cornea, radians

  /// Height of the surface over the sphere towards `direction` (unit) when the eye looks along `gaze` (unit).
  double bulge(const Vector3d& direction, const Vector3d& gaze) const;
};

class LidControl {
 public:
  /// `side`: "left" or "right". Needs the skin regions loop:<side>UpperLidMargin and loop:<side>LowerLidMargin,
  /// <side>UpperLid, <side>LowerLid and <side>Brow.
  LidControl(const HeadTemplate& head, const EyeShape& eye, const std::string& side);

  /// Handles that put the lids where the motion says, keep them at rest for a zero motion, and hold the brow while
  /// lids close.
  std::vector<Handle> handles(const LidMotion& motion) const;

  /// Keeps lids and socket off the eyeball.
  Obstacle eyeball(const LidMotion& motion) const;

  /// Puts the margins and their lining exactly where the motion says, and points of the skin that an expression moved
  /// into the eyeball back onto it. `rest`: of the drawn skin; points that start farther than 2 mm from the eyeball are
  /// not lifted.
  void settle(const MatrixX3d& rest, MatrixX3d& displacement, const LidMotion& motion) const;

  /// Marks the rows of `rest` that settle() places by itself.
  void mark_settled(const MatrixX3d& rest, std::vector<char>& marks) const;

  /// 1 for vertices at the margins of the lids, 0 for those that no margin leads; one entry per row of volume.V.
  const VectorXd& nearness() const { return nearness_; }

 private:
  /// A place in front of the eye: share of the way from the inner to the outer canthus, angle about the canthal axis (0
  /// straight ahead, positive up), distance from the middle of the eye.
  struct Place {
    double across, elevation, distance;
  };
  /// Elevations in one half plane through the canthal axis, radians.
  struct Fissure {
    double lower, lower_inner, upper_inner, upper;  ///< outer and inner edges of the margins
    double orbit;                                   ///< where the lid ends below the brow
  };
  Place place(const Vector3d& X) const;
  Fissure fissure(double across) const;
  Fissure moved(const Fissure& rest, const LidMotion& motion) const;
  /// Where the motion takes a point.
  Vector3d carried(const Vector3d& X, const LidMotion& motion) const;
  /// 1 where the lids decide, 0 where they have no say.
  double lead(const Place& p) const;
  /// How far settle() decides over a point of the drawn skin, 0 to 1.
  double exact(const Vector3d& X) const;
  Vector3d gaze(const LidMotion& motion) const;
  /// x, or the point of the eyeball's surface (plus clearance) above it, for a point at `distance` at rest.
  Vector3d outside(const Vector3d& x, double distance, const Vector3d& gaze) const;

  EyeShape eye_;
  double sign_ = 1;                       ///< +1 left, -1 right
  Vector3d inner_, axis_, up_, ahead_;    ///< inner canthus, canthal axis (to the outer one), directions across it
  double length_ = 0;                     ///< between the canthi
  std::array<VectorXd, 5> curves_;        ///< the fields of Fissure, evenly spaced in `across`
  VectorXd upper_height_, lower_height_;  ///< distance of the margins' outer edges from the middle of the eye, likewise
  VectorXd nearness_;
  std::vector<std::pair<int, Vector3d>> led_;   ///< vertices of the simulation skin that the lids lead, at rest
  std::vector<std::pair<int, Vector3d>> brow_;  ///< those above the lid, held while it closes
  std::vector<std::pair<int, double>> near_;  ///< vertices near the eyeball and their distance from its centre at rest
};

}  // namespace phiz
