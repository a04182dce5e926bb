// SPDX-License-Identifier: GPL-3.0-or-later
/// The tongue: a closed surface that lies between the lower teeth and can be put out.
#pragma once

#include "phiz/anatomy/builtin/proportions.h"
#include "phiz/anatomy/head_template.h"

namespace phiz {

/// The part "tongue", carried by the mandible, with the shape "tongueOut" (to be shown with a slightly open jaw: at
/// full weight the tip reaches about 25 mm beyond the teeth).
Part make_tongue(const Proportions& proportions);

}  // namespace phiz
