// SPDX-License-Identifier: GPL-3.0-or-later
/// Reads the open data of the open-anatomy head from folders as their makers give them out.
#pragma once

#include <cstdint>
#include <string>

#include "phiz/anatomy/open/sources.h"

namespace phiz {

/// ICT Face Model Light: `folder` or a subfolder of it holds generic_neutral_mesh.obj, the 53 expressions and the 100
/// identities, as plain files or in a .tar.xz, .tar.gz or .zip archive. Centimetres become metres. Throws
/// phiz::Error(bad_input) that names every missing file, or the file and what is wrong with it.
FaceKit read_face_kit(const std::string& folder);

/// BodyParts3D: `folder` or its subfolders hold files whose names begin with "FMA" and the number of the part (.ply,
/// .stl or .obj). Millimetres become metres, +z up becomes +y up. Throws phiz::Error(bad_input) that names every
/// missing part, or the file and what is wrong with it.
BodyParts read_body_parts(const std::string& folder);

/// A number that changes when one of the files that the two functions above would read changes (names and contents).
std::uint64_t fingerprint_face_kit(const std::string& folder);
std::uint64_t fingerprint_body_parts(const std::string& folder);

}  // namespace phiz
