// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/lid_muscles.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace phiz {
namespace {

constexpr double share_of_lid = 0.6;  ///< of a lid's flesh that muscles fill, at least

struct Filling {
  double fraction = 0;
  Vector3d direction = Vector3d::UnitX();
};

/// Flesh tets with a corner in one of the contact regions.
std::vector<int> tets_of(const HeadTemplate& head, const std::vector<std::string>& regions) {
  std::vector<char> inside(static_cast<std::size_t>(head.volume.V.rows()), 0);
  for (const ContactRegion& region : head.contact_regions)
    if (std::find(regions.begin(), regions.end(), region.name) != regions.end())
      for (const int f : region.triangles.reshaped()) inside[static_cast<std::size_t>(f)] = 1;
  std::vector<int> tets;
  for (int t = 0; t < head.volume.T.rows(); ++t) {
    if (head.volume.region[t] != Tissue::flesh) continue;
    bool touches = false;
    for (int k = 0; k < 4; ++k) touches = touches || inside[static_cast<std::size_t>(head.volume.T(t, k))] != 0;
    if (touches) tets.push_back(t);
  }
  return tets;
}

}  // namespace

void extend_muscles_to_lids(HeadTemplate& head) {
  VectorXd filled = VectorXd::Zero(head.volume.T.rows());
  for (const Muscle& muscle : head.muscles)
    for (Eigen::Index i = 0; i < muscle.tets.size(); ++i) filled[muscle.tets[i]] += muscle.fraction[i];
  for (Muscle& muscle : head.muscles) {
    const bool left = muscle.name == "orbicularisOculiLeft";
    if (!left && muscle.name != "orbicularisOculiRight") continue;
    const std::string side = left ? "left" : "right";
    const Vector3d eye = left ? head.left_eye_centre : head.right_eye_centre;
    std::map<int, Filling> filling;
    for (Eigen::Index i = 0; i < muscle.tets.size(); ++i)
      filling[muscle.tets[i]] = {muscle.fraction[i], muscle.direction.row(i).transpose()};
    for (const int t : tets_of(head, {side + "UpperLid", side + "LowerLid"})) {
      const double missing = share_of_lid - filled[t];
      if (!(missing > 0)) continue;
      const auto [at, is_new] = filling.try_emplace(t);
      at->second.fraction += missing;
      if (!is_new) continue;
      Vector3d centre = Vector3d::Zero();
      for (int k = 0; k < 4; ++k) centre += head.volume.V.row(head.volume.T(t, k)).transpose() / 4;
      const Vector3d round = Vector3d::UnitZ().cross(centre - eye);
      if (round.norm() > 0) at->second.direction = round.normalized();
    }
    const auto count = static_cast<Eigen::Index>(filling.size());
    muscle.tets.resize(count);
    muscle.fraction.resize(count);
    muscle.direction.resize(count, 3);
    Eigen::Index row = 0;
    for (const auto& [tet, share] : filling) {
      muscle.tets[row] = tet;
      muscle.fraction[row] = share.fraction;
      muscle.direction.row(row++) = share.direction.transpose();
    }
  }
}

}  // namespace phiz
