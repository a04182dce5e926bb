// SPDX-License-Identifier: GPL-3.0-or-later
/// Refusal of malformed meshes. Each function throws phiz::Error(bad_input) naming the first thing that is wrong;
/// `where` (a file or a part) is put in front of the message. Topology (closedness, manifoldness, orientation) is asked
/// for separately, see topology.h.
#pragma once

#include <string>

#include "phiz/geometry/mesh.h"

namespace phiz {

/// Accepts any number of vertices and triangles; refuses NaN, infinite and absurdly large coordinates, indices out of
/// range, triangles that use a vertex twice, FUV of another length than F.
void validate(const TriangleMesh& mesh, const std::string& where);

/// The same for polygons: three to 10,000 corners, no corner twice, one uv per corner, groups in range.
void validate(const PolygonMesh& mesh, const std::string& where);

/// Also refuses tets whose volume is not positive (inverted or flat to rounding) and a region list of another length.
void validate(const TetMesh& mesh, const std::string& where);

/// Refuses triangles of area below `min_area` (square metres), naming the first.
void require_no_degenerate_triangles(const TriangleMesh& mesh, const std::string& where, double min_area = 1e-16);

/// Refuses a surface that is not closed, manifold and consistently oriented, naming the first edge or vertex.
void require_closed_manifold(const TriangleMesh& mesh, const std::string& where);

/// Refuses a surface that intersects itself, naming the first two triangles and how many pairs there are.
void require_no_self_intersections(const TriangleMesh& mesh, const std::string& where);

}  // namespace phiz
