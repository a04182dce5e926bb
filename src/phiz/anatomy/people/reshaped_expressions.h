// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "phiz/anatomy/head_template.h"

namespace phiz {

/// The affine part of a displacement of points about each of `at`: by least squares with Gaussian weights of deviation
/// `reach` (metres). Across flat neighbourhoods, where nothing is known, it is the identity.
std::vector<Matrix3d> local_gradients(const MatrixX3d& points, const MatrixX3d& displacement, const MatrixX3d& at,
                                      double reach);

/// The expressions of `head` on the skin `skin` (n_skin x 3) with the joint `joint`: the share of a displacement that
/// goes with the jaw turns about the joint, the rest is turned and stretched as the skin is.
std::vector<Expression> reshaped_expressions(const HeadTemplate& head, const MatrixX3d& skin, const JawJoint& joint);

}  // namespace phiz
