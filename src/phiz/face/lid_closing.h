// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "phiz/anatomy/head_template.h"

namespace phiz {

/// How much every expression of `head` closes an eye (`side`: "left" or "right"), as a share of what its blink does:
/// the way that the middle halves of the margins of its lids go towards each other. Blinks of the other eye count
/// nothing. Empty when the head has no such blink or no regions <side>UpperLidMargin and <side>LowerLidMargin.
VectorXd lid_closing(const HeadTemplate& head, const std::string& side);

}  // namespace phiz
