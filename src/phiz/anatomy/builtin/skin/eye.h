// SPDX-License-Identifier: GPL-3.0-or-later
/// The eyeball: a sphere with a corneal bulge and boundary loops at limbus and pupil, so that its parts can be
/// coloured.
#pragma once

#include "phiz/anatomy/builtin/proportions.h"
#include "phiz/geometry/mesh.h"

namespace phiz {

enum class EyePart : int { sclera, iris, pupil };

struct Eye {
  TriangleMesh mesh;  ///< closed, outward; metres, head frame, looking along +z; UVs: disc seen from the front
  VectorXi part;      ///< EyePart per triangle
};

/// The left or right eye. `rings`: latitude rings from pole to pole, at least 12.
Eye build_eye(const Proportions& proportions, bool left, int rings = 48);

}  // namespace phiz
