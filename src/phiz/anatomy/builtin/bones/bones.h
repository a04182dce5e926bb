// SPDX-License-Identifier: GPL-3.0-or-later
/// Skull and mandible of a person of the built-in kind.
#pragma once

#include "phiz/anatomy/bones/settle_bones.h"
#include "phiz/anatomy/builtin/proportions.h"

namespace phiz {

/// Bones for the simulation, under flesh of the usual thickness (flesh_thickness.h); see settle_bones.
BoneSurfaces build_bones(const Proportions& proportions, const BoneEnvelope& skin, const TriangleMesh& simulated_skin,
                         const BoneOptions& options);

/// Bones to look at: the same with their alveolar processes, which stand in the oral cavity inside the gums.
BoneSurfaces build_drawn_bones(const Proportions& proportions, const BoneEnvelope& skin, const BoneOptions& options);

}  // namespace phiz
