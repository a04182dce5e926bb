// SPDX-License-Identifier: GPL-3.0-or-later
/// Triangle meshes as polygon meshes, for writers that know only polygons.
#pragma once

#include "phiz/geometry/mesh.h"

namespace phiz {

/// The same surface with one three-cornered face per triangle; texture coordinates are kept.
PolygonMesh as_polygons(const TriangleMesh& mesh);

}  // namespace phiz
