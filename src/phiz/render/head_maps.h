// SPDX-License-Identifier: GPL-3.0-or-later
/// Internal: colours and names of what the styles attachments and contacts paint. Included by sources only.
#pragma once

#include <string>

#include "phiz/geometry/mesh.h"

namespace phiz::detail {

Vector3d pinned_colour();
Vector3d sliding_colour();
Vector3d bare_bone_colour();

/// "leftUpperLid" as "left upper lid".
std::string readable(const std::string& name);

}  // namespace phiz::detail
