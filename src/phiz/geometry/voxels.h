// SPDX-License-Identifier: GPL-3.0-or-later
/// The inside of a surface on a regular grid: for shapes too thin, too many or too messy to be meshed.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "phiz/geometry/mesh.h"

namespace phiz {

/// Cubes of edge `spacing` (metres) side by side, x fastest.
struct VoxelGrid {
  Vector3d low = Vector3d::Zero();  ///< corner of the first voxel
  double spacing = 0;
  Eigen::Vector3i size = Eigen::Vector3i::Zero();

  std::ptrdiff_t count() const { return std::ptrdiff_t{size.x()} * size.y() * size.z(); }
  /// Distance of two voxels that are neighbours along an axis, in the numbering of voxels.
  std::ptrdiff_t stride(int axis) const {
    return axis == 0 ? 1 : axis == 1 ? size.x() : std::ptrdiff_t{size.x()} * size.y();
  }
  /// Column, row and layer of a voxel.
  Eigen::Vector3i cell(std::ptrdiff_t voxel) const;
  Vector3d centre(std::ptrdiff_t voxel) const {
    return low + spacing * (cell(voxel).cast<double>().array() + 0.5).matrix();
  }
  /// The voxel that holds p, or -1.
  std::ptrdiff_t holding(const Vector3d& p) const;
};

/// One flag per voxel.
using VoxelFlags = std::vector<char>;

/// The voxels within `radius` (metres) of a flagged one, measured between centres.
VoxelFlags dilate(const VoxelGrid& grid, const VoxelFlags& flags, double radius);
/// `flags` and the gaps between them that a ball of that radius does not fit into (a morphological closing). The grid
/// must leave `radius` free round the flags.
VoxelFlags close_gaps(const VoxelGrid& grid, const VoxelFlags& flags, double radius);
/// Pieces of flagged voxels that share faces: their number per voxel from 0, in order of their first voxel, or -1.
/// Flagged voxels must not touch the side of the grid.
std::vector<int> voxel_pieces(const VoxelGrid& grid, const VoxelFlags& flags);

/// A surface on a grid. What is inside is decided by the winding number (more than one half), so pieces may touch,
/// overlap and have small holes.
class SurfaceVoxels {
 public:
  /// The grid reaches `margin` (metres, at least one voxel) beyond the surface. Throws phiz::Error(bad_input) when the
  /// mesh is malformed or empty, or when there would be more than 2e8 voxels.
  SurfaceVoxels(const TriangleMesh& surface, double spacing, double margin);
  ~SurfaceVoxels();
  SurfaceVoxels(SurfaceVoxels&&) noexcept;
  SurfaceVoxels& operator=(SurfaceVoxels&&) noexcept;

  const VoxelGrid& grid() const;
  /// Per voxel: its centre is inside of the surface.
  const VoxelFlags& inside() const;
  /// Exact (not to the voxel), and quick away from the surface.
  bool contains(const Vector3d& p) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace phiz
