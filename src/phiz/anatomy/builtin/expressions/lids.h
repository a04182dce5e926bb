// SPDX-License-Identifier: GPL-3.0-or-later
/// The lids of one eye: sheets that slide round the eyeball. Each margin turns about the axis through the canthi and
/// the middle of the eye; the skin above and below follows less and less.
#pragma once

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
  /// `side`: "left" or "right". Needs the skin regions loop:<side>UpperLidMargin and loop:<side>LowerLidMargin.
  LidControl(const HeadTemplate& head, const EyeShape& eye, const std::string& side);

  /// Handles that put the margins where the motion says, and keep them at rest for a zero motion.
  std::vector<Handle> handles(const LidMotion& motion) const;

  /// Keeps lids and socket off the eyeball.
  Obstacle eyeball(const LidMotion& motion) const;

  /// Puts points of the skin that an expression moved into the eyeball back onto it. `rest`: where they are at rest;
  /// those that start farther than 2 mm from the eyeball are left alone.
  void lift_off(const MatrixX3d& rest, MatrixX3d& displacement, const LidMotion& motion) const;

  /// 1 for vertices at the margins of the lids, 0 for those that no margin leads; one entry per row of volume.V.
  const VectorXd& nearness() const { return nearness_; }

 private:
  struct LidVertex {
    int vertex;
    double across;     ///< 0 inner canthus, 1 outer canthus
    double elevation;  ///< angle about the canthal axis, radians, 0 straight ahead, positive up
    double follow;     ///< how far it goes with its margin, 1 to 0
    double weight;
    double flat;  ///< distance from the middle of the eye that it sinks to when its lid is drawn over the eye
    bool upper;
    Vector3d rest;
  };
  Vector3d gaze(const LidMotion& motion) const;
  /// x, or the point of the eyeball's surface (plus clearance) above it, for a point at `distance` at rest.
  Vector3d outside(const Vector3d& x, double distance, const Vector3d& gaze) const;
  double elevation(const Vector3d& p) const;

  EyeShape eye_;
  double sign_ = 1;                     ///< +1 left, -1 right
  Vector3d axis_, up_, ahead_;          ///< canthal axis (towards the outer canthus), and the directions across it
  VectorXd upper_angle_, lower_angle_;  ///< elevation of the margins, evenly spaced in `across`
  VectorXd nearness_;
  std::vector<LidVertex> vertices_;
  std::vector<std::pair<int, double>> near_;  ///< vertices near the eyeball and their distance from its centre at rest
};

}  // namespace phiz
