// SPDX-License-Identifier: GPL-3.0-or-later
/// Solid shapes from untidy pieces, by way of voxels: caves filled, gaps sealed, distances.
#pragma once

#include <vector>

#include "phiz/geometry/mesh.h"
#include "phiz/geometry/remesh.h"
#include "phiz/geometry/voxels.h"

namespace phiz {

/// Unit vectors spread evenly over the sphere (golden spiral).
std::vector<Vector3d> sphere_directions(int count);

/// The grid whose cells cover `box` and `margin` around it. Throws phiz::Error(bad_input) for more than 3e8 cells.
VoxelGrid grid_round(const Box& box, double spacing, double margin);

/// Marks the cells whose centres lie inside of `mesh` (crossing number of rays along x above zero; pieces may overlap),
/// on top of what `solid` (one flag each) holds.
void fill_inside(const VoxelGrid& grid, const TriangleMesh& mesh, VoxelFlags& solid);

/// Distance from every cell to the nearest marked one, metres (Felzenszwalb and Huttenlocher 2012); a large number
/// everywhere when none is marked.
std::vector<float> distance_to(const VoxelGrid& grid, const VoxelFlags& marked);

/// Fills gaps narrower than twice `radius`, and whatever a ball of that radius cannot reach from outside.
void seal_gaps(const VoxelGrid& grid, double radius, VoxelFlags& solid);

/// Fills the cells from which at least the share `hidden` of all directions end in the solid within the grid: caves and
/// chambers, however many small doors they have. Tested on cells of `coarse` times the size.
void fill_caves(const VoxelGrid& grid, double hidden, int coarse, VoxelFlags& solid);

/// A value per cell, interpolated linearly between centres and held beyond the outer ones.
class VoxelField {
 public:
  VoxelField(const VoxelGrid& grid, std::vector<float> values) : grid_(grid), values_(std::move(values)) {}
  double operator()(const Vector3d& p) const;
  const VoxelGrid& grid() const { return grid_; }

 private:
  VoxelGrid grid_;
  std::vector<float> values_;
};

/// Distance to the surface of the solid, negative inside, smoothed over a cell, metres.
VoxelField signed_distance_field(const VoxelGrid& grid, const VoxelFlags& solid);

}  // namespace phiz
