// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/expressions/teeth.h"

#include <algorithm>
#include <cmath>

#include "phiz/anatomy/builtin/expressions/skin.h"

namespace phiz {
namespace {

/// An elliptic wall between two heights. level(p) is 1 on the labial surface of the teeth.
struct Wall {
  double half_width, depth, z0, bottom, top;

  double level(const Vector3d& p) const { return std::hypot(p.x() / half_width, std::max(0.0, p.z() - z0) / depth); }
  bool beside(const Vector3d& p) const { return p.y() > bottom && p.y() < top && p.z() > 0.3 * z0; }
  Vector3d lifted(const Vector3d& p, double least) const {
    const double at = level(p);
    if (!beside(p) || at >= least || at < 0.5) return p;
    const double scale = least / at;
    return {p.x() * scale, p.y(), p.z() > z0 ? z0 + (p.z() - z0) * scale : p.z()};
  }
};

}  // namespace

Obstacle dental_arches(const HeadTemplate& head, const Proportions::DentalArch& arch, const Eigen::Isometry3d& jaw) {
  const Wall upper{arch.half_width, arch.depth, arch.z0, arch.upper_edge, arch.upper_sulcus};
  const Wall lower{arch.half_width - arch.lower_inset, arch.depth - arch.lower_inset, arch.z0, arch.lower_sulcus,
                   arch.lower_edge};
  constexpr double least = 1.012;  // half a millimetre in front of the incisors
  Obstacle obstacle;
  std::vector<std::pair<double, double>> floors;
  for (const int v : head.skin_vertices) {
    const Vector3d X = head.volume.V.row(v);
    if (head.carrier[v] != static_cast<int>(Carrier::flesh) || X.y() > upper.top || X.y() < lower.bottom) continue;
    const double above = upper.level(X), below = lower.level(X);
    if (above < 0.97 || above > 1.35) continue;
    obstacle.vertices.push_back(v);
    floors.emplace_back(std::min(above, least), std::min(below, least));
  }
  obstacle.weight = 2;
  obstacle.allowed = [upper, lower, floors, jaw](std::size_t k, const Vector3d& x) -> Vector3d {
    const Vector3d y = upper.lifted(x, floors[k].first);
    return jaw * lower.lifted(jaw.inverse() * y, floors[k].second);
  };
  return obstacle;
}

std::vector<Handle> floor_handles(const HeadTemplate& head, const Eigen::Isometry3d& jaw) {
  std::vector<Handle> handles;
  const std::vector<char> floor = simulation_mask(head, {"oralFloor"});
  for (std::size_t i = 0; i < floor.size(); ++i) {
    const int v = head.skin_vertices[static_cast<Eigen::Index>(i)];
    if (floor[i] && head.carrier[v] == static_cast<int>(Carrier::flesh))
      handles.push_back({v, jaw * Vector3d(head.volume.V.row(v).transpose()), 0.3});
  }
  return handles;
}

}  // namespace phiz
