// SPDX-License-Identifier: GPL-3.0-or-later
/// The colours of a head's skin and eyes.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "phiz/anatomy/head_template.h"

namespace phiz {

/// Colour per skin vertex (n x 3, linear RGB, to be multiplied with the albedo of skin_material()): lips and ears
/// redder, mouth and sockets wet red, a shadow of hair on the scalp where the regions of HeadTemplate::skin_regions say
/// so. Unknown regions are skipped; borders are blurred over a few millimetres.
MatrixX3d paint_skin(const TriangleMesh& skin, const std::map<std::string, VectorXi>& regions);

/// Pattern of hair over the skin at rest: brows along the landmarks "17" to "21" and "22" to "26", roots of lashes
/// along the loops of the lid margins. Empty when the head has neither.
std::function<Vector3d(const Vector3d&)> hair_pattern(const HeadTemplate& head);

/// Pattern of an eyeball at rest that looks along +z: sclera with a warm rim, iris with fibres and a dark limbal ring,
/// pupil. Albedo over that of eye_material(). `radius` of the eyeball.
std::function<Vector3d(const Vector3d&)> eye_pattern(const Vector3d& centre, double radius);

}  // namespace phiz
