// SPDX-License-Identifier: GPL-3.0-or-later
/// The skin of the face kit as a head needs it: closed, lips apart, with named regions; and as a simulation needs it.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "phiz/anatomy/open/sources.h"

namespace phiz {

/// The drawn skin: vertices 0 to 14061 are the face kit's, in its order; then come those of the cap of the neck.
struct FaceKitSkin {
  TriangleMesh mesh;  ///< closed, manifold, outward, free of self-intersections; texture coordinates of the face kit
  std::map<std::string, VectorXi> regions;  ///< rows of mesh.V; names as in the built-in skin
  std::vector<int> neck_loop;               ///< where the cap begins
  std::vector<int> lip_line;                ///< where outer skin and mouth meet
  /// Left and right: where outer skin and eye socket meet, behind the lids; and the roots of the lashes, which mark the
  /// margins of the lids.
  std::array<std::vector<int>, 2> socket_lines, upper_lashes, lower_lashes;
};

/// Throws phiz::Error(bad_input) when the mesh is not laid out as the face kit's, phiz::Error(failure) when it cannot
/// be freed of self-intersections.
FaceKitSkin make_face_kit_skin(const FaceKit& kit);

/// Displacements of the kit's skin (at least 14062 x 3), and of the cap, which follows the loop of the neck.
MatrixX3d with_cap(const FaceKitSkin& skin, const MatrixX3d& of_kit);

/// The simulation skin: about `vertices` of them on the drawn skin, fine at lips, lids and nose, coarse at scalp and
/// shoulders, free of self-intersections.
TriangleMesh simulation_skin(const FaceKitSkin& skin, int vertices);

}  // namespace phiz
