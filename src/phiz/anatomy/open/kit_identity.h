// SPDX-License-Identifier: GPL-3.0-or-later
/// The people of the face kit as a model of the head's skin.
#pragma once

#include "phiz/anatomy/head_template.h"
#include "phiz/anatomy/open/face_kit_skin.h"

namespace phiz {

/// The kit's modes on the drawn skin. Where the mouth and the eye sockets are lined they follow the outer skin smoothly
/// instead: the kit's own modes move that lining against its teeth and eyes by 2 to 4 mm.
IdentityModel kit_identity(const FaceKit& kit, const FaceKitSkin& skin);

}  // namespace phiz
