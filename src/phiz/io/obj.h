// SPDX-License-Identifier: GPL-3.0-or-later
/// Wavefront OBJ.
#pragma once

#include <string>
#include <string_view>

#include "phiz/geometry/mesh.h"

namespace phiz {

/// Reads vertices, texture coordinates, polygons of any size and groups. Indices may be relative (negative), lines may
/// end in LF, CR LF or CR and may be continued with a backslash. The group of a face is the latest `g` or `o`
/// statement. Normals, materials, lines, points and curves are skipped. Where only some faces have texture coordinates
/// the others get (0, 0). Throws phiz::Error(bad_input) "file:line: ..." for numbers that are none or not finite,
/// indices out of range, faces with fewer than three corners or with a corner twice, and a file without vertices.
PolygonMesh read_obj(const std::string& path);

/// The same from memory; `where` names the text in messages.
PolygonMesh parse_obj(std::string_view text, const std::string& where);

/// Writes a mesh; coordinates with 9 significant digits, optional vertex normals (as many rows as vertices).
void write_obj(const std::string& path, const PolygonMesh& mesh, const MatrixX3d& normals = {});
void write_obj(const std::string& path, const TriangleMesh& mesh, const MatrixX3d& normals = {});

/// Name of a frame of a sequence: "out/face.obj", 7 becomes "out/face.0007.obj".
std::string sequence_name(const std::string& path, int frame);

}  // namespace phiz
