// SPDX-License-Identifier: GPL-3.0-or-later
/// What a FibreField knows. Private to fibre_field.cpp and fibre_trace.cpp.
#pragma once

#include <optional>
#include <vector>

#include "phiz/anatomy/fibre_field.h"
#include "phiz/anatomy/harmonic_flow.h"

namespace phiz {

struct FibreField::State {
  SurfaceVoxels voxels;
  HarmonicFlow flow;
  bool ring = false;
  Vector3d ring_centre = Vector3d::Zero(), ring_axis = Vector3d::UnitZ();
  Eigen::AlignedBox3d box;  // of the surface

  const VoxelGrid& grid() const { return voxels.grid(); }
  /// The row of the solved voxel that holds p, or -1.
  int row_at(const Vector3d& p) const {
    const std::ptrdiff_t voxel = grid().holding(p);
    const int r = voxel < 0 ? -1 : flow.row[static_cast<std::size_t>(voxel)];
    return r >= 0 && flow.solved(r) ? r : -1;
  }

  // Streamlines (fibre_trace.cpp).
  /// Voxels whose value is within `band` of one half; in rings those at a half-plane through the axis.
  std::vector<Vector3d> seed_candidates(double band) const;
  /// p, or a place inside near it when it has left through a step of the side; nothing when it has left for good.
  std::optional<Vector3d> held_inside(const Vector3d& p) const;
  /// The line from p with the flow (way = 1) or against it (-1), p first.
  std::vector<Vector3d> walk(const FibreField& field, const Vector3d& p, int way) const;
};

}  // namespace phiz
