// SPDX-License-Identifier: GPL-3.0-or-later
/// Better shapes for the worst tets of a mesh, with its surfaces kept (Freitag and Ollivier-Gooch 1997; Klingner and
/// Shewchuk 2007).
#pragma once

#include <string>

#include "phiz/geometry/mesh.h"

namespace phiz {

struct ImproveOptions {
  /// Tets whose smallest dihedral angle, or supplement of the largest one, is below this are worked on, degrees, in
  /// [0, 60); 0: none.
  double target = 12;
  /// New inner vertices only for tets below this, degrees: they cost tets.
  double insert_below = 6;
  int passes = 20;  ///< over all such tets, twice; fewer when none gets better any more
  /// How far each vertex of a surface may move from where it is, metres; empty: none may. A surface keeps its
  /// triangles, so the give should be small against its edges.
  VectorXd give;
};

struct ImproveSummary {
  int passes = 0;
  int below_before = 0, below_after = 0;     ///< tets below the target
  double worst_before = 0, worst_after = 0;  ///< smallest of the angles named at `target`, degrees
  int moves = 0, flips = 0, contractions = 0, insertions = 0;
  double largest_surface_move = 0;  ///< metres
};
std::string brief_report(const ImproveSummary& summary);

/// Moves, flips, merges and adds until no tet is below the target or nothing helps. A surface is what bounds the mesh
/// or parts two regions: its triangles stay faces, its vertices keep their rows, which must come first in `mesh.V`, and
/// their places (but see `give`). No tet is ever inverted, the worst angle never falls. Inner vertices and tets change
/// their rows. Serial and deterministic.
/// Throws phiz::Error(usage) on bad options, phiz::Error(bad_input) when a tet is inverted or flat, or when a vertex of
/// a surface comes after one that is not.
ImproveSummary improve_tets(TetMesh& mesh, const ImproveOptions& options = {});

/// The moves alone: tets and rows stay as they are, and inverted tets are turned back where that is possible. Of the
/// options `target`, `give` and `passes` count. Returns the worst angle reached, degrees; negative when inverted.
double smooth_tets(TetMesh& mesh, const ImproveOptions& options);

}  // namespace phiz
