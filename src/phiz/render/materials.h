// SPDX-License-Identifier: GPL-3.0-or-later
/// Ready materials of a head. Linear RGB.
#pragma once

#include "phiz/render/scene.h"

namespace phiz {

Material clay_material();     ///< warm grey, matt: for judging form
Material skin_material();     ///< skin with reddish terminator and a soft gloss
Material eye_material();      ///< wet, sharp glint
Material enamel_material();   ///< teeth
Material gum_material();      ///< wet mucosa: gums, tongue
Material bone_material();     ///< dry bone
Material hair_material();     ///< lashes
Material section_material();  ///< cuts: matt, and nearly as unlit as a legend; white, to be coloured
Material muscle_material();   ///< moist; white, to be coloured by Surface::colour

}  // namespace phiz
