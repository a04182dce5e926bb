// SPDX-License-Identifier: GPL-3.0-or-later
/// The standard lighting of the pictures.
#pragma once

#include <vector>

#include "phiz/render/camera.h"
#include "phiz/render/scene.h"

namespace phiz {

/// Soft key from the upper left of the camera, weak fill from the right, rim light from behind: placed relative to the
/// camera so that every view is lit the same, scaled to the scene's bounding box.
std::vector<AreaLight> studio_lights(const Camera& camera, const Eigen::AlignedBox3d& box);

}  // namespace phiz
