// SPDX-License-Identifier: GPL-3.0-or-later
/// Lips that an expression leaves closed, and their corners.
#pragma once

#include "phiz/anatomy/head_template.h"

namespace phiz {

/// Draws the lips together where `displacement` (of head.skin, metres) parts them by more than at rest: both move half
/// the way, the skin round them less and less; where they touch they move alike. Needs the skin regions
/// loop:upperLipLine and loop:lowerLipLine.
void seal_lips(const HeadTemplate& head, MatrixX3d& displacement);

/// Lets both lips move alike in the corners of the mouth and in the creases behind them, of lips that part elsewhere.
void join_corners(const HeadTemplate& head, MatrixX3d& displacement);

}  // namespace phiz
