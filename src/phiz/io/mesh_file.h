// SPDX-License-Identifier: GPL-3.0-or-later
/// Meshes in any file format that Phiz reads, and the question whether their unit is metres.
#pragma once

#include <string>

#include "phiz/geometry/mesh.h"

namespace phiz {

/// Reads .obj, .ply, .stl, .gltf or .glb by the extension (glTF: all meshes of the scene, placed by their nodes).
/// Throws phiz::Error(bad_input); an unknown extension names the known ones.
PolygonMesh read_mesh(const std::string& path);

/// Writes .obj, .ply, .stl, .gltf or .glb by the extension. Throws phiz::Error(usage) for another extension.
void write_mesh(const std::string& path, const TriangleMesh& mesh);

/// The unit in which a head-like mesh (a face, a head, a bust) seems to be measured.
struct SuspectedUnit {
  std::string name;   ///< "metres", "centimetres", "millimetres" or "unknown"
  double metres = 1;  ///< length of one unit in metres; 1 when unknown
  double extent = 0;  ///< longest side of the bounding box, in units of the file
};

/// Judges by the longest side of the bounding box: 0.08 to 3 is metres, 8 to 80 centimetres, 80 to 3000 millimetres.
SuspectedUnit suspect_unit(const MatrixX3d& V);

/// What to tell the user of a mesh in centimetres or millimetres: the unit, the size and the mend. Empty for others.
std::string unit_defect(const MatrixX3d& V);

}  // namespace phiz
