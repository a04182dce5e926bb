// SPDX-License-Identifier: GPL-3.0-or-later
/// Harmonic functions on voxels and their gradients. Private to fibre_field.cpp and fibre_trace.cpp.
#pragma once

#include <cstddef>
#include <vector>

#include "phiz/geometry/voxels.h"

namespace phiz {

/// A harmonic function on the flagged voxels of a grid, and the unit vectors along its gradient. Pieces of the domain
/// on which it is not determined have zero vectors.
struct HarmonicFlow {
  std::vector<std::ptrdiff_t> voxels;  ///< the domain, ascending
  std::vector<int> row;                ///< row of `voxels` per voxel of the grid, or -1
  VectorXd value;                      ///< in [0, 1] between two ends; turns round a ring, with one jump by 1
  MatrixX3d direction;                 ///< unit or zero

  /// Whether the function is determined at that row.
  bool solved(int r) const { return !direction.row(r).isZero(); }
  /// How many voxels have a direction.
  std::ptrdiff_t solved_count() const;
};

/// 0 at the voxels round `origin`, 1 at those round `insertion`, no flow through the sides. Undetermined on pieces that
/// have only one of them.
HarmonicFlow flow_between(const VoxelGrid& grid, const VoxelFlags& domain, const MatrixX3d& origin,
                          const MatrixX3d& insertion);

/// The angle round an axis, in turns, made harmonic. Undetermined on pieces that do not close round the axis.
HarmonicFlow flow_round(const VoxelGrid& grid, const VoxelFlags& domain, const Vector3d& centre, const Vector3d& axis);

/// The plain circles round an axis, for rings that close nowhere.
HarmonicFlow circles_round(const VoxelGrid& grid, const VoxelFlags& domain, const Vector3d& centre,
                           const Vector3d& axis);

}  // namespace phiz
