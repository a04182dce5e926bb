// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "phiz/anatomy/builtin/skin/form.h"

namespace phiz {
namespace {

/// The vault of the skull: a superellipsoid, deeper behind than in front.
struct Vault {
  Vector3d centre{0, 66, -22};
  double half_width = 76, height = 74, depth = 105, front = 95.5, back = 88.5, exponent = 2.25;

  double level(const Vector3d& d) const {
    return std::pow(std::abs(d.x()) / half_width, exponent) +
           std::pow(std::abs(d.y()) / (d.y() > 0 ? height : depth), exponent) +
           std::pow(std::abs(d.z()) / (d.z() > 0 ? front : back), exponent);
  }
  /// The point of the vault in the direction of p from the centre.
  Vector3d under(const Vector3d& p) const {
    const Vector3d d = p - centre;
    return centre + d * std::pow(level(d), -1 / exponent);
  }
  /// Height of the vault over (x, z).
  double top(double x, double z) const {
    const double rest = 1 - level({x, 0, z - centre.z()});
    return centre.y() + height * std::pow(std::max(rest, 0.0), 1 / exponent);
  }
};

}  // namespace

Vector3d coons(const SkinForm& form, const std::function<int(int, int)>& vertex, int u, int p, int v, int q) {
  const auto at = [&](int a, int b) { return form.at(vertex(a, b)); };
  const double s = static_cast<double>(u) / p, t = static_cast<double>(v) / q;
  const Vector3d midline = (1 - t) * at(0, 0) + t * at(0, q);
  const Vector3d corners =
      (1 - s) * (1 - t) * at(0, 0) + s * (1 - t) * at(p, 0) + (1 - s) * t * at(0, q) + s * t * at(p, q);
  return (1 - s) * midline + s * at(p, v) + (1 - t) * at(u, 0) + t * at(u, q) - corners;
}

void place_vault(SkinForm& form) {
  const SkinTopology& topology = skin_topology();
  const Vault vault;
  for (int j = 11; j <= SkinTopology::rows; ++j)
    for (int i = j < 13 ? 16 : j <= 20 ? 15 : j <= 23 ? 12 : 0; i <= SkinTopology::columns; ++i) {
      const int v = topology.sheet(i, j);
      if (v < 0 || !form.placed(v)) continue;
      const double share = j == 24 && i < 12 ? 0.5 : 1.0;  // the forehead keeps some of its own form
      form.place(v, form.at(v) + share * (vault.under(form.at(v)) - form.at(v)),
                 j < 23 && i < 16          ? 0.15
                 : j == SkinTopology::rows ? 0.08
                                           : 0.5);
    }
  for (int u = 0; u < 4; ++u)
    for (int v = 1; v < 8; ++v) {
      const Vector3d p = coons(
          form, [&](int a, int b) { return topology.crown(a, b); }, u, 4, v, 8);
      form.place(topology.crown(u, v), {p.x(), vault.top(p.x(), p.z()), p.z()}, 0.08);
    }
}

}  // namespace phiz
