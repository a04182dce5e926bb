// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <numbers>

#include "phiz/anatomy/builtin/skin/form.h"

namespace phiz {
namespace {

/// The neck is an upright oval column: its sections at the lowest rows, millimetres.
struct NeckSection {
  int j;
  double y, half_width, half_depth, centre_z;
  double muscle_angle;  // of the ridge of the sternocleidomastoid, degrees from the front
  double larynx;        // how far the larynx stands out
};
constexpr NeckSection neck_sections[] = {
    {0, -170, 52, 47, -45, 26, 0.5}, {1, -146, 49, 46.5, -41, 42, 1.5}, {2, -121, 47.5, 47.5, -37.5, 62, 3.2}};
constexpr double neck_angles[SkinTopology::columns + 1] = {0,  9,  18,  27,  36,  46,  56,  66, 76,
                                                           86, 96, 106, 117, 129, 142, 161, 180};

}  // namespace

void place_neck(SkinForm& form) {
  const SkinTopology& topology = skin_topology();
  for (const NeckSection& section : neck_sections)
    for (int i = 0; i <= SkinTopology::columns; ++i) {
      const double angle = neck_angles[i] * std::numbers::pi / 180;
      const auto ridge = [&](double at, double width) { return std::exp(-std::pow((neck_angles[i] - at) / width, 2)); };
      const double muscle = 2.2 * ridge(section.muscle_angle, 11) - 1.6 * ridge(section.muscle_angle - 24, 12);
      const double larynx = section.larynx * ridge(0, 12);
      const double swell = 1 + (muscle + larynx) / section.half_depth;
      form.place(topology.sheet(i, section.j), {swell * section.half_width * std::sin(angle), section.y,
                                                section.centre_z + swell * section.half_depth * std::cos(angle)});
    }
  const auto foot = [&](int u, int v) { return topology.foot(u, v); };
  for (int u = 0; u <= 6; ++u)
    for (int v = 0; v <= 4; ++v) {
      if (u < 6 && v > 0 && v < 4) form.place(foot(u, v), coons(form, foot, u, 6, v, 4));
      form.keep_control(foot(u, v));
    }
}

}  // namespace phiz
