// SPDX-License-Identifier: GPL-3.0-or-later
/// The 5-DoF jaw joint (Ichim et al. 2017, section 3).
#pragma once

#include <Eigen/Geometry>
#include <string>

#include "phiz/geometry/mesh.h"

namespace phiz {

/// Pose of the mandible relative to the skull: rotation about the condyle axis (opening, radians), rotation about the
/// vertical axis (lateral swing, radians; positive turns the chin to the person's left), and the translation of the
/// condyles (metres).
using JawPose = Eigen::Matrix<double, 5, 1>;  // open, swing, tx, ty, tz

/// The joint: its centre is midway between the condyles, its opening axis joins them. In the head frame (+x to the
/// person's left, +y up, +z forward) both are given by the template.
struct JawJoint {
  Vector3d centre = Vector3d::Zero();  ///< midpoint of the condyles, metres
  Vector3d axis = Vector3d::UnitX();   ///< unit opening axis, from the right condyle to the left one
  Vector3d up = Vector3d::UnitY();     ///< unit swing axis, perpendicular to `axis`
  JawPose lower = JawPose::Zero();     ///< lower limits
  JawPose upper = JawPose::Zero();     ///< upper limits
};

/// Rigid motion of the mandible: Trans(o + t) R_up(b1) R_axis(b0) Trans(-o). Positive b0 opens the mouth.
Eigen::Isometry3d jaw_transform(const JawJoint& joint, const JawPose& pose);

/// Derivative of jaw_transform(joint, pose) * point with respect to the pose: 3 x 5.
Eigen::Matrix<double, 3, 5> jaw_jacobian(const JawJoint& joint, const JawPose& pose, const Vector3d& point);

}  // namespace phiz
