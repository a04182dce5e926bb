// SPDX-License-Identifier: GPL-3.0-or-later
/// Tetrahedral meshes whose faces contain given surfaces exactly.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "phiz/geometry/mesh.h"

namespace phiz {

/// A closed, outward, manifold surface, in one or more pieces. It bounds the region directly inside of it (up to the
/// surfaces nested in it). Space that is inside of a piece facing inward stays empty.
struct RegionSurface {
  std::string name;  ///< for messages, e.g. "skull"
  TriangleMesh surface;
  int region = 1;       ///< tag of the tets directly inside
  bool hole = false;    ///< leave the inside empty
  double max_edge = 0;  ///< wanted longest edge of the tets directly inside, metres; 0: as the surfaces suggest
  VectorXd give = {};  ///< how far each vertex may move for better tets (ImproveOptions::give), metres; empty: none may
};

struct TetrahedraliseOptions {
  double radius_edge_ratio = 1.5;  ///< bound on circumradius / shortest edge (TetGen -q), > 1.1
  double min_dihedral = 10;        ///< smallest dihedral angle asked for, degrees, in [0, 18]
  double max_edge = 0;             ///< for regions without their own; 0: none
  /// Wanted edge length at a point (metres), <= 0 for no wish; wins over max_edge where it is smaller. Must be
  /// thread-safe.
  std::function<double(const Vector3d&)> sizing;
  int target_tets = 0;        ///< scales the edge lengths until the tet count is within 5 % of this; 0: off
  int smoothing_passes = 4;   ///< passes of quality-improving relocation of interior vertices afterwards
  double improve_below = 12;  ///< then tets with angles below this are improved (ImproveOptions::target), degrees
  double insert_below = 6;    ///< with new inner vertices below this, degrees; raises the count of tets a little
};

/// Tets between and inside the surfaces. The vertices of the surfaces come first, in the order given; every input
/// triangle is a face of the result (no vertex is added on a surface, and they move only where a surface has `give`).
/// The worst dihedral angle comes out at about `insert_below` where the surfaces allow it: they must not be folded more
/// sharply than twice that, nor come much closer to each other than a fifth of their edges. Deterministic.
/// Throws phiz::Error(bad_input) naming the surface and triangles that are open, non-manifold, inward,
/// self-intersecting or crossing each other; phiz::Error(failure) when the mesher gives up. Hang Si's TetGen (ACM TOMS
/// 41, 2015).
TetMesh tetrahedralise(std::span<const RegionSurface> surfaces, const TetrahedraliseOptions& options = {});

/// Quality of a tet mesh.
struct TetQuality {
  Eigen::Index tets = 0;
  Eigen::Index vertices = 0;
  double min_dihedral = 0, max_dihedral = 0;           ///< degrees
  double min_radius_ratio = 0, mean_radius_ratio = 0;  ///< 3 inradius / circumradius: 1 regular, 0 flat
  int worst_tet = -1;                                  ///< row with the smallest radius ratio
  double min_edge = 0, mean_edge = 0, max_edge = 0;    ///< metres
  double min_volume = 0, total_volume = 0;             ///< cubic metres
  std::array<int, 10> radius_ratio_histogram{};        ///< bins of width 0.1
};
TetQuality tet_quality(const TetMesh& mesh);
std::string brief_report(const TetQuality& quality);

/// 3 inradius / circumradius of one tet; negative when inverted.
double radius_ratio(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d);
/// Smallest and largest dihedral angle of one tet, degrees.
std::array<double, 2> dihedral_range(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d);

/// Moves the vertices that are not `fixed` (n flags) and have a poor tet (radius ratio below 0.5) round them, to lower
/// the sum of ratio^-4 there; never inverts a tet and never lowers the worst ratio round a vertex, nor the worst angle
/// (as in ImproveOptions::target) where it is below `kept_angle`, degrees. Returns the number of moves.
int smooth_interior(TetMesh& mesh, const std::vector<char>& fixed, int passes, double kept_angle = 0);

}  // namespace phiz
