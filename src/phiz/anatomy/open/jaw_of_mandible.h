// SPDX-License-Identifier: GPL-3.0-or-later
/// The joint of the jaw from the shape of a mandible, and its pose from points that move with it.
#pragma once

#include <array>

#include "phiz/anatomy/jaw.h"

namespace phiz {

/// Centres of the heads of the condyles, left first: the middle of the top 6 mm of the hindmost part of each side.
std::array<Vector3d, 2> condyle_centres(const MatrixX3d& mandible);

/// The joint whose axis joins the condyles, with the limits of an adult's jaw.
JawJoint joint_of(const std::array<Vector3d, 2>& condyles);

/// The pose that brings `rest` nearest to `moved` (same rows, at least three, not in one line): the rigid motion of
/// least squares without its roll. `residual`, when given, receives the largest distance that is left, metres.
JawPose fit_jaw_pose(const JawJoint& joint, const MatrixX3d& rest, const MatrixX3d& moved, double* residual = nullptr);

}  // namespace phiz
