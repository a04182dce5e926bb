// SPDX-License-Identifier: GPL-3.0-or-later
/// Cut-aways: surfaces and tets cut by a plane, with the cut shown.
#pragma once

#include <map>
#include <vector>

#include "phiz/render/scene.h"

namespace phiz {

/// The half space { x : (x - point) . normal <= 0 } is kept.
struct CutPlane {
  Vector3d point = Vector3d::Zero();
  Vector3d normal = Vector3d::UnitX();
};

/// The part of a surface that is kept. Crossing triangles are cut; normals, colours, fibres, rest positions and
/// edge flags follow. The cut edge itself is not drawn in wireframes. Throws phiz::Error(bad_input) for a plane without
/// direction.
Surface cut_surface(const Surface& surface, const CutPlane& plane);

/// The cross-section of tets: a flat surface in the plane, facing the removed side, coloured by region tag. Tags that
/// are not in `colours` get `other`. With `cells`, the edges of the tets' sections are drawn.
Surface cross_section(const TetMesh& mesh, const CutPlane& plane, const std::map<int, Vector3d>& colours,
                      bool cells = false, const Vector3d& other = Vector3d(0.4, 0.4, 0.4));

/// Likewise with a colour per tet (rows of mesh.T).
Surface cross_section(const TetMesh& mesh, const CutPlane& plane, const MatrixX3d& tet_colours, bool cells = false);

/// The cut of a closed surface as a flat surface in the plane, facing the removed side: what lies inside an odd number
/// of shells. `mesh` is in its own frame; the result has the same transform and material as `surface`. Where the
/// surface is open, a straight line closes its section.
Surface cap(const Surface& surface, const CutPlane& plane);

/// The cut of solids that may overlap, such as the strands of a muscle: what lies inside any of them. A connected part
/// of the surface that faces outward is a solid; one that faces inward is a hollow of the solids whose bounds hold it.
Surface solid_cap(const Surface& surface, const CutPlane& plane);

}  // namespace phiz
