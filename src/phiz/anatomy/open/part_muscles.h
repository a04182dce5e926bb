// SPDX-License-Identifier: GPL-3.0-or-later
/// The muscles of BodyParts3D in another face: between its bones and its skin, the lip muscles inside its lips.
#pragma once

#include <span>

#include <vector>

#include "phiz/anatomy/fibre_field.h"
#include "phiz/anatomy/open/face_guide.h"
#include "phiz/anatomy/open/face_kit_skin.h"
#include "phiz/anatomy/open/registration.h"

namespace phiz {

/// The muscles of expression of phace.md section 3 (fourteen pairs without levator anguli oris, procerus, orbicularis
/// oris) and the masseters, in the frame of the face, with their origins and insertions. `bones`: skull and mandible
/// there, as they are and as they are simulated: muscles stay out of all of them.
std::vector<MuscleShape> part_muscles(const BodyParts& parts, const SpaceMap& map, const FaceGuide& guide,
                                      const FaceKitSkin& skin, std::span<const TriangleMesh> bones);

}  // namespace phiz
