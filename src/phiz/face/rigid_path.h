// SPDX-License-Identifier: GPL-3.0-or-later
/// Where a rigid thing is over time: an object that meets a face, or the head itself.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "phiz/geometry/mesh.h"

namespace phiz {

struct RigidPath {
  std::vector<double> time;               ///< seconds, ascending
  std::vector<Eigen::Isometry3d> places;  ///< one per time, metres

  /// Between two times: translation in a straight line, rotation along the shorter arc; at rest before and after.
  Eigen::Isometry3d at(double t) const;
};

/// A path that stays in one place.
RigidPath resting_at(const Eigen::Isometry3d& place);

/// From one place to another, share in [0, 1].
Eigen::Isometry3d between(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, double share);

/// Throws phiz::Error(bad_input) for a path without places, counts that differ, times that do not ascend, places that
/// are not finite or farther than 100 m away.
void validate(const RigidPath& path, const std::string& where);

}  // namespace phiz
