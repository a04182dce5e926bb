// SPDX-License-Identifier: GPL-3.0-or-later
/// Which way the fibres of a muscle run: along the gradient of a harmonic function that is 0 at the origin and 1 at the
/// insertion and lets nothing through the sides (Choi and Blemker 2013, doi 10.1371/journal.pone.0077576; phace.md
/// section 5.1). In a ring the function is an angle that grows by one turn on the way round the opening.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <vector>

#include "phiz/geometry/mesh.h"

namespace phiz {

/// A muscle before it is put into a head.
struct MuscleShape {
  std::string name;
  /// Outward. It may consist of many strands that touch, overlap or lie apart, and may have small defects.
  TriangleMesh surface;
  MatrixX3d origin;     ///< points at the fixed end, metres, on or near the surface; unused in rings
  MatrixX3d insertion;  ///< points at the moving end
  bool ring = false;    ///< the fibres go round an opening
  Vector3d ring_centre = Vector3d::Zero();
  Vector3d ring_axis = Vector3d::UnitZ();  ///< fibres go round it right-handed
};

struct FibreOptions {
  double spacing = 0.0006;    ///< edge of the voxels on which the function is solved, metres
  int most_voxels = 60'000;   ///< larger muscles get larger voxels
  double widest_gap = 0.004;  ///< strands up to twice this apart (metres) are joined for the solve when they must be
};

/// Fibre directions everywhere in and near one muscle. The function is solved on the voxels inside of the surface, with
/// the seven-point stencil. When they are not one piece, gaps between strands are closed first, by as little as makes
/// nine tenths of them one piece; what still lies apart takes the direction of its surroundings.
class FibreField {
 public:
  /// Throws phiz::Error(bad_input) naming the muscle when its surface is malformed, encloses nothing, or an end that is
  /// needed is missing or not finite.
  explicit FibreField(const MuscleShape& shape, const FibreOptions& options = {});
  ~FibreField();
  FibreField(FibreField&&) noexcept;
  FibreField& operator=(FibreField&&) noexcept;

  /// Bounds of the surface.
  Eigen::AlignedBox3d box() const;
  /// Whether p is inside of the surface.
  bool contains(const Vector3d& p) const;
  /// Unit, towards the insertion or round the ring. Beyond the muscle: that of the nearest part of it.
  Vector3d direction(const Vector3d& p) const;

  /// Between `fewest` and `most` streamlines from origin to insertion, spread over the middle of the muscle at least
  /// 2 mm apart where there is room, each of `points` points at equal distances; rings are closed: the last point is
  /// the first again.
  std::vector<MatrixX3d> trace(int fewest = 8, int most = 40, int points = 21) const;

  /// The closed manifold outward surface of the voxels, smoothed: for shapes whose own surface is no manifold.
  TriangleMesh voxel_surface() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace phiz
