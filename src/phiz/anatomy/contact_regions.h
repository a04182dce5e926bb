// SPDX-License-Identifier: GPL-3.0-or-later
/// Which patches of the built-in head collide with what.
#pragma once

#include "phiz/anatomy/builtin/skin/surface.h"
#include "phiz/anatomy/head_template.h"

namespace phiz {

/// Fills contact_regions (lips, inner walls of the cheeks, lids) and contact_pairs (lip against lip, lips and cheeks
/// against teeth and gums, lids against eyes and each other). `regions`: those of the simulation skin, whose vertices
/// come first in head.volume. Uses head.skin_triangles and the parts; vertices that lie inside the gums at rest are not
/// checked.
void assign_contacts(HeadTemplate& head, const SkinRegions& regions);

}  // namespace phiz
