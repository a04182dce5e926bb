// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/face/rigid_path.h"

#include <algorithm>
#include <cmath>

#include "phiz/core/error.h"

namespace phiz {

Eigen::Isometry3d between(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, double share) {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.linear() = Eigen::Quaterniond(from.linear()).slerp(share, Eigen::Quaterniond(to.linear())).toRotationMatrix();
  out.translation() = (1 - share) * from.translation() + share * to.translation();
  return out;
}

Eigen::Isometry3d RigidPath::at(double t) const {
  const auto next = static_cast<std::size_t>(std::upper_bound(time.begin(), time.end(), t) - time.begin());
  if (next == 0) return places.front();
  if (next == time.size()) return places.back();
  return between(places[next - 1], places[next], (t - time[next - 1]) / (time[next] - time[next - 1]));
}

RigidPath resting_at(const Eigen::Isometry3d& place) {
  return {{0}, {place}};
}

void validate(const RigidPath& path, const std::string& where) {
  constexpr double farthest = 100;  // metres
  if (path.time.empty() || path.time.size() != path.places.size())
    reject(where, "needs one place for every time, and at least one");
  for (std::size_t k = 0; k < path.time.size(); ++k) {
    const std::string row = "place " + std::to_string(k);
    const Eigen::Isometry3d& place = path.places[k];
    if (!std::isfinite(path.time[k]) || !place.matrix().allFinite()) reject(where, row + " is not finite");
    if (k > 0 && !(path.time[k] > path.time[k - 1]))
      reject(where, "the time of " + row + " is not later than that of the one before");
    if (place.translation().norm() > farthest) reject(where, row + " is more than 100 m away", "lengths are in metres");
    if ((place.linear() * place.linear().transpose() - Matrix3d::Identity()).norm() > 1e-6)
      reject(where, row + " is not a rotation and a translation");
  }
}

}  // namespace phiz
