// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <numbers>

#include "phiz/anatomy/builtin/skin/form.h"

namespace phiz {
namespace {

/// The neck leans forward and widens towards the shoulders: its sections at the lowest rows, millimetres.
struct NeckSection {
  int j;
  double y_front, y_back, z_front, z_back, half_width;
  double muscle_angle;  // of the ridge of the sternocleidomastoid, degrees from the front
  double larynx;        // how far the larynx stands out; negative: the hollow above the breastbone
  double shoulder;      // how far the trapezius stands out
};
constexpr NeckSection neck_sections[] = {{0, -158, -144, 2, -101, 60, 24, -1.5, 6},
                                         {1, -137, -127, 9, -93, 57, 44, 1, 2},
                                         {2, -116, -110, 17, -87, 55, 64, 3.5, 0}};
constexpr double neck_angles[SkinTopology::columns + 1] = {0,  9,  18,  27,  36,  46,  56,  66, 76,
                                                           86, 96, 106, 117, 129, 142, 161, 180};

}  // namespace

void place_neck(SkinForm& form) {
  const SkinTopology& topology = skin_topology();
  for (const NeckSection& section : neck_sections)
    for (int i = 0; i <= SkinTopology::columns; ++i) {
      const double angle = neck_angles[i] * std::numbers::pi / 180;
      const auto ridge = [&](double at, double width) { return std::exp(-std::pow((neck_angles[i] - at) / width, 2)); };
      const double half_depth = 0.5 * (section.z_front - section.z_back), front = 0.5 * (1 + std::cos(angle));
      const double muscle = 2.4 * ridge(section.muscle_angle, 11) - 1.8 * ridge(section.muscle_angle - 24, 12);
      const double relief = muscle + section.larynx * ridge(0, 12) + section.shoulder * ridge(118, 28);
      const double swell = 1 + relief / half_depth;
      const double wedge = angle < 0.5 * std::numbers::pi ? std::pow(std::sin(angle), 1.2) : std::sin(angle);
      form.place(topology.sheet(i, section.j),
                 {swell * section.half_width * wedge, front * section.y_front + (1 - front) * section.y_back,
                  section.z_back + half_depth * (1 + swell * std::cos(angle))});
    }
  const auto foot = [&](int u, int v) { return topology.foot(u, v); };
  for (int u = 0; u <= 6; ++u)
    for (int v = 0; v <= 4; ++v) {
      if (u < 6 && v > 0 && v < 4) form.place(foot(u, v), coons(form, foot, u, 6, v, 4));
      form.keep_control(foot(u, v));
    }
}

}  // namespace phiz
