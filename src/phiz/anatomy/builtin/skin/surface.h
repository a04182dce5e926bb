// SPDX-License-Identifier: GPL-3.0-or-later
/// The skin of the built-in head: a closed quad cage of fixed connectivity and its limit surface at any fineness.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "phiz/anatomy/builtin/proportions.h"
#include "phiz/anatomy/builtin/skin/identity.h"
#include "phiz/anatomy/contact_regions.h"
#include "phiz/anatomy/head_template.h"
#include "phiz/geometry/mesh.h"

namespace phiz {

/// Regions here (SkinRegions): named vertex sets and ordered loops. Sets (ascending): upperLip, lowerLip,
/// upperLipInner, lowerLipInner, mouthBag, oralRoof, oralFloor, leftUpperLid, leftLowerLid, leftSocket, leftNostril,
/// leftEar, leftBrow, leftCheek (and right...), nose, scalp, forehead, chin, neck, neckCap, jawLine. Loops (in order):
/// "loop:upperLipLine" and "loop:lowerLipLine" from the right corner of the mouth to the left one along the parting;
/// "loop:leftUpperLidMargin" and "loop:leftLowerLidMargin" from the inner to the outer canthus along the outer edge of
/// the lid margin (and right...).

/// The control cage. It is closed, manifold, outward oriented, and has the same faces for every person. Its limit
/// surface (Catmull-Clark) is the skin; the cage itself lies a little off it.
struct SkinSurface {
  PolygonMesh cage;                 ///< quads with UVs; metres, head frame
  SkinRegions regions;              ///< rows of cage.V
  std::vector<Landmark> landmarks;  ///< "0".."67" of the usual markup and named ones, as rows of cage.V
};

/// The skin of a person: proportions = personalise(mean, identity) with the same identity. Throws phiz::Error
/// (bad_input) for proportions or parameters that are not finite or make no head.
SkinSurface build_skin(const Proportions& proportions, const IdentityParameters& identity);

/// The skin at one level of fineness. Every vertex lies on the limit surface, and vertex i of a level is vertex i of
/// every finer level, so landmarks keep their index.
struct RefinedSkin {
  TriangleMesh mesh;        ///< quads split along the diagonal that is better on the mean person, with UVs
  PolygonMesh quads;        ///< the same vertices, with UVs
  SparseMatrixd from_cage;  ///< n x cage vertices: mesh.V = from_cage * cage.V; rows sum to 1
  SkinRegions regions;      ///< rows of mesh.V; loops gain the vertices on their edges
};

/// Level 0 has the cage's vertices (about 1700), each level about four times as many. 0 <= level <= 4, else bad_input.
RefinedSkin refine(const SkinSurface& skin, int level);

/// Rows sum to 1; n_fine x n_coarse. Multiplied by displacements of the vertices of level `coarse` gives displacements
/// of the vertices of level `fine` by subdivision of the coarse mesh, corrected so that shared vertices keep their
/// displacement nearly exactly. coarse <= fine.
SparseMatrixd skin_interpolation_between(const SkinSurface& skin, int coarse, int fine);

}  // namespace phiz
