// SPDX-License-Identifier: GPL-3.0-or-later
/// The texture map of the cage: a convex-face (Tutte) embedding of each island, packed into the unit square.
#pragma once

#include "phiz/geometry/mesh.h"

namespace phiz {

/// Fills mesh.UV and mesh.face_uvs of the cage whose vertices are `mesh.V` and whose faces are those of
/// skin_topology().
void unwrap_skin(PolygonMesh& mesh);

}  // namespace phiz
