// SPDX-License-Identifier: GPL-3.0-or-later
/// The passive flesh of a head: given where some of its points are pulled to and how the jaw stands, finds where all
/// the rest goes. As-rigid-as-possible plus volume energy on the tets (volumetric-face-rig.md section 6), bones rigid.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <vector>

#include "phiz/geometry/mesh.h"

namespace phiz {

/// A vertex of the tet mesh that is pulled to `target` with a spring; `weight` is the ratio of the spring's stiffness
/// to the stiffness of the flesh round the vertex: 0.1 suggests, 1 guides, 10 holds.
struct Handle {
  int vertex = -1;
  Vector3d target = Vector3d::Zero();
  double weight = 1;
};

/// A vertex that a muscle draws: its place along `direction` (unit) is pulled to `target`, across it is nearly
/// free, so that flesh which is shortened may thicken. `weight` as for a handle.
struct Pull {
  int vertex = -1;
  Vector3d target = Vector3d::Zero();
  Vector3d direction = Vector3d::UnitX();
  double weight = 1;
};

/// Vertices that must stay out of something rigid (teeth, eyeball). `allowed(k, x)` returns the nearest allowed place
/// for vertices[k] at x: x itself when it touches nothing. It is asked in every iteration.
struct Obstacle {
  std::vector<int> vertices;
  double weight = 2;
  std::function<Vector3d(std::size_t k, const Vector3d& x)> allowed;
};

class FleshPoser {
 public:
  /// `carrier`: Carrier per vertex of `volume`; flesh vertices are free, the others move with skull or mandible.
  /// Tets at `skin_vertices` are stiffer than those below: the dermis spreads a pull over its surroundings.
  /// Throws phiz::Error when a tet is not positive or no vertex is carried.
  FleshPoser(const TetMesh& volume, const VectorXi& carrier, const VectorXi& skin_vertices);
  ~FleshPoser();
  FleshPoser(FleshPoser&&) noexcept;
  FleshPoser& operator=(FleshPoser&&) noexcept;

  /// Positions of all vertices (metres, n x 3), after `iterations` local/global steps from `guess` (such positions),
  /// or from a smooth first guess when it is empty.
  MatrixX3d pose(const std::vector<Handle>& handles, const std::vector<Pull>& pulls,
                 const std::vector<Obstacle>& obstacles, const Eigen::Isometry3d& jaw, int iterations,
                 const MatrixX3d& guess = {}) const;

  /// Share with which each vertex follows the mandible: 1 on it, 0 on the skull, harmonic between (n).
  const VectorXd& jaw_share() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace phiz
