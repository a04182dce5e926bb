// SPDX-License-Identifier: GPL-3.0-or-later
/// What the parts of a head look like in exported files.
#pragma once

#include <string>

#include "phiz/anatomy/head_template.h"
#include "phiz/io/gltf.h"

namespace phiz {

/// Chosen by the name of a part: "skin", teeth, gums, tongue, bones, eyes; something neutral otherwise.
GltfMaterial head_material(const std::string& part_name);

/// Texture coordinates for an eyeball that look along +z: the front pole is the centre of the texture of the eye's
/// material, the equator and everything behind it its rim. One coordinate per vertex.
TriangleMesh with_eye_texture_coordinates(const TriangleMesh& eye, const Vector3d& centre);

}  // namespace phiz
