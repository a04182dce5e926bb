// SPDX-License-Identifier: GPL-3.0-or-later
/// PLY, the format of scanners.
#pragma once

#include <string>
#include <string_view>

#include "phiz/geometry/mesh.h"

namespace phiz {

/// What a PLY file may say about its vertices beside their position. Empty matrices where it says nothing.
struct PlyAttributes {
  MatrixX3d normals;  ///< as stored, n x 3
  MatrixX3d colours;  ///< red, green, blue in [0, 1], n x 3
};

/// Reads ascii, binary little-endian and binary big-endian PLY. Elements other than `vertex` and `face` and unknown
/// properties are skipped; texture coordinates per vertex (u v, s t, texture_u texture_v) become UV. A file without
/// faces is a point cloud: `faces` is empty. Throws phiz::Error(bad_input) naming the line or element; a header that
/// claims more than the file can hold is refused before any memory is taken.
PolygonMesh read_ply(const std::string& path, PlyAttributes* attributes = nullptr);
PolygonMesh parse_ply(std::string_view bytes, const std::string& where, PlyAttributes* attributes = nullptr);

enum class PlyEncoding { ascii, binary_little_endian, binary_big_endian };
/// Writes positions (as double), faces, UV of vertices when the UV index is the vertex index, and the attributes given.
void write_ply(const std::string& path, const PolygonMesh& mesh, const PlyAttributes& attributes = {},
               PlyEncoding encoding = PlyEncoding::binary_little_endian);
void write_ply(const std::string& path, const TriangleMesh& mesh);

}  // namespace phiz
