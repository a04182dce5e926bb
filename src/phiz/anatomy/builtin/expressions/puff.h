// SPDX-License-Identifier: GPL-3.0-or-later
/// Air in the mouth: pressure on the soft part of the cheeks.
#pragma once

#include <vector>

#include "phiz/anatomy/builtin/expressions/flesh.h"
#include "phiz/anatomy/builtin/proportions.h"
#include "phiz/anatomy/head_template.h"

namespace phiz {

/// Handles that push the buccal part of cheeks, inside and outside, and a little of the skin round the lips outward;
/// `amount`: at the middle of the cheek, metres.
std::vector<Handle> puff_handles(const HeadTemplate& head, const Proportions& proportions, double amount);

}  // namespace phiz
