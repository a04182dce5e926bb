// SPDX-License-Identifier: GPL-3.0-or-later
/// STL, the format of 3D printing: triangles without shared vertices.
#pragma once

#include <string>
#include <string_view>

#include "phiz/geometry/mesh.h"

namespace phiz {

/// Reads ascii or binary STL. Corners at exactly the same position become one vertex (numbered in order of first
/// appearance); triangles that lose their area by that are dropped; stored normals are ignored.
/// Throws phiz::Error(bad_input) with the line or the triangle.
TriangleMesh read_stl(const std::string& path);
TriangleMesh parse_stl(std::string_view bytes, const std::string& where);

/// Writes binary (default) or ascii STL with the triangles' normals.
enum class StlEncoding { binary, ascii };
void write_stl(const std::string& path, const TriangleMesh& mesh, StlEncoding encoding = StlEncoding::binary);

}  // namespace phiz
