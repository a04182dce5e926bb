// SPDX-License-Identifier: GPL-3.0-or-later
/// Twenty-eight teeth and the gums that hold them, on the arches of Proportions. They stand inside the oral cavity.
#pragma once

#include "phiz/anatomy/builtin/proportions.h"
#include "phiz/geometry/mesh.h"

namespace phiz {

/// Fourteen crowns with short roots, each a closed surface; left and right are mirror images. Crown sizes after the
/// means of Wheeler's Dental Anatomy, scaled to the arch. Nothing reaches beyond the labial outline of the arch.
TriangleMesh make_upper_teeth(const Proportions& proportions);
TriangleMesh make_lower_teeth(const Proportions& proportions);

/// The gum of one jaw: one closed band round the necks of the teeth, scalloped between them.
TriangleMesh make_upper_gums(const Proportions& proportions);
TriangleMesh make_lower_gums(const Proportions& proportions);

}  // namespace phiz
