// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/skin/form.h"

namespace phiz {

void place_nostrils(SkinForm& form) {
  const SkinTopology& topology = skin_topology();
  // The tunnel narrows upwards and back, away from the rim's centre.
  const Vector3d axis[4] = {{0, 0, 0}, {0.1, 2, -0.6}, {0, 6.5, -2.6}, {-0.6, 11, -6}};
  constexpr double scale[4] = {1, 0.94, 0.86, 0.6};
  Vector3d centre = Vector3d::Zero();
  for (int c = 0; c < SkinTopology::nostril_columns; ++c)
    centre += form.at(topology.nostril(0, c)) / SkinTopology::nostril_columns;
  for (int ring = 1; ring <= SkinTopology::nostril_rings; ++ring)
    for (int c = 0; c < SkinTopology::nostril_columns; ++c) {
      const Vector3d from = form.at(topology.nostril(0, c)) - centre;
      form.place(topology.nostril(ring, c), centre + axis[ring] + scale[ring] * from, 10);
    }
  form.place(topology.nostril_end(), centre + Vector3d(-0.8, 12.5, -7), 10);
}

}  // namespace phiz
