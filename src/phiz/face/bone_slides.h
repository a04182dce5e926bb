// SPDX-License-Identifier: GPL-3.0-or-later
/// Flesh that slides on bone (phace.md 4.3): the surface near each sliding vertex, and how it moves with the jaw.
#pragma once

#include <vector>

#include "phiz/anatomy/head_template.h"
#include "phiz/elasticity/tissue_body.h"

namespace phiz {

using Matrix3x5d = Eigen::Matrix<double, 3, 5>;
using RowVector5d = Eigen::Matrix<double, 1, 5>;

/// One slide per sliding vertex of head.attachments, in their order, in the rest pose: the paraboloid through the
/// vertex, across its normal, that fits the bone about 12 mm around best. Where the bone is rough the fit is damped
/// towards the tangent plane; it bends by at most 1 / (16 mm), so that its normal turns by no more than 30 degrees when
/// flesh slides by 8 mm. Bones are rough: of the points of the bone within 5 mm, half are within 0.3 mm of the
/// paraboloid (0.1 mm on the open head's calvaria) and 90 % within 1.5 mm, most of the rest at the edges of cheekbone,
/// orbit and jaw.
std::vector<Slide> bone_slides(const HeadTemplate& head);

/// A slide of the rest pose in a pose of the jaw: those on the mandible move along.
Slide placed(const HeadTemplate& head, const Slide& rest, const JawPose& pose);

/// Derivatives of the height and the gradient of placed(head, rest, pose) at a fixed point x by the pose.
struct SlideRate {
  RowVector5d height;
  Matrix3x5d gradient;
};
SlideRate slide_rate(const HeadTemplate& head, const Slide& rest, const JawPose& pose, const Vector3d& x);

}  // namespace phiz
