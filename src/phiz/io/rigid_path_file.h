// SPDX-License-Identifier: GPL-3.0-or-later
/// Paths of rigid things as tables.
#pragma once

#include <string>
#include <string_view>

#include "phiz/face/rigid_path.h"

namespace phiz {

/// Reads a table with a header: columns time (seconds), x, y, z (metres) and, all or none, the quaternion qw, qx, qy,
/// qz; in any order. Quaternions are normalised. Throws phiz::Error(bad_input) with file:line for missing or unknown
/// columns, text where a number is expected, times that do not ascend.
RigidPath read_rigid_path(const std::string& path);
RigidPath parse_rigid_path(std::string_view text, const std::string& where);

}  // namespace phiz
