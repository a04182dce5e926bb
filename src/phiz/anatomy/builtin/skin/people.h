// SPDX-License-Identifier: GPL-3.0-or-later
/// The people of the built-in head as a linear model of its skin.
#pragma once

#include "phiz/anatomy/builtin/skin/surface.h"
#include "phiz/anatomy/head_template.h"

namespace phiz {

/// Principal modes, largest first, of the drawn skin `mean` (refined from the mean person's) under the covariance of
/// the identity parameters, by central differences of one deviation each way.
IdentityModel builtin_people(const RefinedSkin& mean);

}  // namespace phiz
