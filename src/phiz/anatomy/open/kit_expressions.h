// SPDX-License-Identifier: GPL-3.0-or-later
/// The expressions of the face kit under ARKit's names.
#pragma once

#include <vector>

#include "phiz/anatomy/head_template.h"
#include "phiz/anatomy/open/face_kit_skin.h"
#include "phiz/anatomy/open/sources.h"

namespace phiz {

/// All 52 in ARKit's order: displacements of the skin, whose cap of the neck rests, and the pose of the jaw as the
/// lower teeth show it. Pairs that ARKit has as one (browInnerUp, cheekPuff) are added. The backs of the lids follow
/// their fronts and the depth of the sockets rests; in the kit the lining moves by itself, through bone. tongueOut,
/// which the kit lacks, opens the mouth enough for the tongue; the tongue itself is a shape of its part.
/// `jaw_residual`, when given, receives the largest distance between a lower tooth and its place, metres.
std::vector<Expression> kit_expressions(const FaceKit& kit, const FaceKitSkin& skin, const JawJoint& joint,
                                        double* jaw_residual = nullptr);

}  // namespace phiz
