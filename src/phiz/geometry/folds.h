// SPDX-License-Identifier: GPL-3.0-or-later
/// Folds of a deformed surface: edges over which one triangle is turned against the other.
#pragma once

#include <utility>
#include <vector>

#include "phiz/geometry/mesh.h"

namespace phiz {

/// Finds edges at which a deformed surface is folded over, and evens it out around them. Built once for a surface at
/// rest; looks at part of its triangles.
class FoldMender {
 public:
  /// An edge is folded when the cosine between the normals of its triangles is below `least`; edges that are bent by
  /// more than a right angle at rest (the creases of lids and lips) are left alone.
  /// Looks at the edges whose both triangles have a corner that is flagged in `vertices`.
  FoldMender(const TriangleMesh& rest, const std::vector<char>& vertices, double least);

  /// Pairs of triangles that are folded at positions V.
  std::vector<std::pair<int, int>> folded(const MatrixX3d& V) const;

  /// Moves the vertices of folded pairs half the way to the mean of their neighbours, until nothing is folded or 40
  /// rounds are over; from the tenth round on their neighbours too. Leaves a surface without folds as it is, bit for
  /// bit. V: one row per vertex, metres. Returns the number of edges that stay folded.
  int mend(MatrixX3d& V) const;

 private:
  Eigen::Matrix3Xd unit_normals(const MatrixX3d& V) const;

  MatrixX3i F_;
  double least_;
  std::vector<int> watched_;                  ///< triangles with a flagged corner
  std::vector<std::pair<int, int>> across_;   ///< places in watched_, of every edge not creased at rest
  std::vector<std::vector<int>> neighbours_;  ///< vertices round a vertex
};

}  // namespace phiz
