// SPDX-License-Identifier: GPL-3.0-or-later
/// Internal: anti-aliased edge lines. Included by sources only.
#pragma once

#include "phiz/render/lens.h"
#include "phiz/render/ray_scene.h"

namespace phiz::detail {

/// How much of the line of the nearest drawn edge of the hit triangle covers pixel position (x, y), in [0, 1].
float wire_coverage(const Lens& lens, const ShadedPoint& point, float x, float y);

}  // namespace phiz::detail
