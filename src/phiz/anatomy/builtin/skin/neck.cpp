// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <numbers>

#include "phiz/anatomy/builtin/skin/cranium.h"
#include "phiz/anatomy/builtin/skin/form.h"

namespace phiz {
namespace {

/// What stands out of the neck's round at its lowest rows, millimetres.
struct NeckRow {
  int j;
  double y, slope;      // height at z = 0, and its rise towards the back
  double muscle_angle;  // of the ridge of the sternocleidomastoid, degrees from the front
  double muscle;        // how far it stands out
  double larynx;        // likewise; negative: the hollow above the breastbone
};
constexpr NeckRow neck_rows[] = {{0, -169, 0.06, 22, 1, -1.5}, {1, -163, 0.06, 26, 1, -1}, {2, -122, 0, 52, 1.6, 1.4}};
constexpr double neck_angles[SkinTopology::columns + 1] = {0,  9,   18,  27,  36,  46,  56,  66,  76, 86,
                                                           96, 105, 113, 121, 130, 141, 153, 166, 180};
constexpr double cut_rim = 4;  // between the edge of the cut and the ring inside it

}  // namespace

void place_neck(SkinForm& form) {
  const SkinTopology& topology = skin_topology();
  for (const NeckRow& row : neck_rows)
    for (int i = 0; i <= SkinTopology::columns; ++i) {
      const double angle = neck_angles[i];
      const auto ridge = [&](double at, double width) { return std::exp(-std::pow((angle - at) / width, 2)); };
      const double relief = row.muscle * (ridge(row.muscle_angle, 13) - 0.7 * ridge(row.muscle_angle - 26, 14)) +
                            row.larynx * ridge(0, 18);
      Vector3d p = cranium_point(angle, row.y);
      const Vector3d out(std::sin(angle * std::numbers::pi / 180), 0, std::cos(angle * std::numbers::pi / 180));
      p += relief * out;
      p.y() -= row.slope * p.z();
      form.place(topology.sheet(i, row.j), p);
    }
  const Vector3d middle(0, -166.3, -46);
  for (int i = 0; i <= SkinTopology::columns; ++i) {
    const Vector3d edge = form.at(topology.sheet(i, 0));
    form.place(topology.foot_rim(i), edge + cut_rim * (middle - edge).normalized());
    form.keep_control(topology.foot_rim(i));
  }
  const auto foot = [&](int u, int v) { return topology.foot(u, v); };
  for (int u = 0; u < SkinTopology::foot_columns; ++u)
    for (int v = 1; v < SkinTopology::foot_rows; ++v) {
      form.place(foot(u, v), coons(form, foot, u, SkinTopology::foot_columns, v, SkinTopology::foot_rows));
      form.keep_control(foot(u, v));
    }
}

}  // namespace phiz
