// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/expressions/puff.h"

#include <cmath>

namespace phiz {

std::vector<Handle> puff_handles(const HeadTemplate& head, const Proportions& p, double amount) {
  // The buccal window: between cheekbone and jaw line, in front of the masseter.
  const double y = p.cheilion.y() + 0.006, x = p.cheilion.x() + 0.017;
  const double z = 0.62 * p.cheilion.z() + 0.38 * p.gonion.z() + 0.010;
  std::vector<Handle> handles;
  for (const int v : head.skin_vertices) {
    const Vector3d X = head.volume.V.row(v);
    if (head.carrier[v] != static_cast<int>(Carrier::flesh)) continue;
    for (const double side : {1.0, -1.0}) {
      const Vector3d d = X - Vector3d(side * x, y, z);
      const double r = std::sqrt(std::pow(d.x() / 0.038, 2) + std::pow(d.y() / 0.038, 2) + std::pow(d.z() / 0.046, 2));
      if (r >= 1) continue;
      const double bump = 1 - r * r * (2 - r * r);
      const Vector3d outward = Vector3d(side * 0.8, -0.05, 0.6).normalized();
      handles.push_back({v, X + amount * bump * outward, 0.1 + 1.2 * bump});
    }
  }
  return handles;
}

}  // namespace phiz
