// SPDX-License-Identifier: GPL-3.0-or-later
/// Teeth, gums, tongue and eyes of the face kit as parts of a head.
#pragma once

#include <vector>

#include "phiz/anatomy/head_template.h"
#include "phiz/anatomy/open/sources.h"

namespace phiz {

/// upperTeeth, lowerTeeth, upperGums, lowerGums, tongue (with its shape tongueOut), leftEye, rightEye, leftLashes,
/// rightLashes. The gums are the kit's sheet with a thickness. The tongue, which in the kit is a part of that sheet and
/// has no underside, is the one of the built-in head between the kit's teeth. The lashes are hairs along the kit's
/// cards.
std::vector<Part> kit_parts(const FaceKit& kit);

}  // namespace phiz
