// SPDX-License-Identifier: GPL-3.0-or-later
/// The skin of a take for programs that do not read glTF: an OBJ per frame, or a point cache with its mesh.
#pragma once

#include <string>

#include "phiz/face/take.h"

namespace phiz {

/// Writes one OBJ per frame with texture coordinates and normals: "X.0000.obj", "X.0001.obj", ... for the path
/// "X.obj". The head pose is applied. Returns the number of files.
int export_take_obj_sequence(const Take& take, const std::string& path);

/// Writes .pc2 or .mdd by the extension and, beside it, the mesh that it deforms: "X.obj" for "X.pc2". The head pose is
/// applied. Throws phiz::Error(usage) for another extension.
void export_take_point_cache(const Take& take, const std::string& path);

}  // namespace phiz
