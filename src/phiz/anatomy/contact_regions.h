// SPDX-License-Identifier: GPL-3.0-or-later
/// Which patches of a head collide with what.
#pragma once

#include <map>
#include <string>

#include "phiz/anatomy/head_template.h"

namespace phiz {

/// Named vertex sets of the simulation skin, rows of HeadTemplate::volume.
using SkinRegions = std::map<std::string, VectorXi>;

/// Fills contact_regions (lips, inner walls of the cheeks, lids) and contact_pairs (lip against lip, lips and cheeks
/// against teeth and gums, lids against eyes and each other). `regions`: those of the simulation skin, whose vertices
/// come first in head.volume; needed are upperLip, lowerLip, upperLipInner, lowerLipInner, mouthBag, oralRoof,
/// oralFloor, and for either side leftUpperLid, leftLowerLid. Uses head.skin_triangles and the parts; gums that are no
/// closed surface are no obstacles. Left out are: vertices inside of gums at rest; what lies behind the last teeth;
/// regions without a triangle.
void assign_contacts(HeadTemplate& head, const SkinRegions& regions);

}  // namespace phiz
