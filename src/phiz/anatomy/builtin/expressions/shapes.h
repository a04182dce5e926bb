// SPDX-License-Identifier: GPL-3.0-or-later
/// The 52 expressions of a head, from its muscles: each recipe is played on the passive flesh over the rigid bones.
#pragma once

#include <vector>

#include "phiz/anatomy/builtin/muscles.h"
#include "phiz/anatomy/builtin/proportions.h"
#include "phiz/anatomy/head_template.h"

namespace phiz {

/// The expressions of expression_names, in that order: displacement of head.skin and jaw pose. Left and right ones are
/// exact mirror images where the skin is symmetric. Needs of `head` its volume, carriers, skin with its lip lines and
/// lid margins, jaw and eye centres. `proportions`: those the head was built from (dental arch, eyeball); `muscles`:
/// its bundles, settled. Throws phiz::Error for a head that lacks a part.
std::vector<Expression> make_expressions(const HeadTemplate& head, const Proportions& proportions,
                                         const std::vector<MuscleBundle>& muscles);

}  // namespace phiz
