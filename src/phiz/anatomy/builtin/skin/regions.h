// SPDX-License-Identifier: GPL-3.0-or-later
/// Named regions and landmarks of the cage; the same for every person.
#pragma once

#include "phiz/anatomy/builtin/skin/surface.h"

namespace phiz {

SkinRegions skin_regions();
std::vector<Landmark> skin_landmarks();

}  // namespace phiz
