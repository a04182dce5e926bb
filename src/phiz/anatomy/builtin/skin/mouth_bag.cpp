// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "phiz/anatomy/builtin/skin/form.h"

namespace phiz {
namespace {

constexpr double fold_depth =
    3;  // control vertices of the folds lie this much deeper in the lip: the surface rounds them
constexpr double wall_gap = 1.3, front_gap = 0.9;  // millimetres between teeth and the wall of the bag

}  // namespace

void place_mouth_bag(SkinForm& form, const Proportions& proportions) {
  const SkinTopology& topology = skin_topology();
  const auto& arch = proportions.arch;
  const double half_width = arch.half_width * 1e3 + wall_gap, depth = arch.depth * 1e3 + front_gap, z0 = arch.z0 * 1e3;
  const double top = arch.upper_sulcus * 1e3, bottom = arch.lower_sulcus * 1e3,
               middle = form.at(topology.mouth(6, 8)).y();
  // On the wall in front of the teeth, by the angle along the arch from the midline (degrees).
  const auto wall = [&](double angle, double y, double beyond) {
    const double a = angle * M_PI / 180;
    return Vector3d((half_width + 0.4 * beyond) * std::sin(a), y, z0 + (depth + beyond) * std::cos(a));
  };
  constexpr double inner_angle[9] = {0, 8, 16, 24.5, 34, 44, 55, 66, 75};
  constexpr double sulcus_angle[9] = {0, 8.5, 17, 26, 36, 47.5, 60, 74, 84};
  constexpr double inner_rise[9] = {1, 1, 0.99, 0.96, 0.9, 0.8, 0.66, 0.46, 0};
  constexpr double sulcus_rise[9] = {1, 1, 1, 0.99, 0.97, 0.95, 0.91, 0.72, 0};
  for (int c = 0; c <= 8; ++c)
    for (const bool upper : {true, false}) {
      const int column = upper ? c : 16 - c;
      const double fold = upper ? top : bottom;
      const double parting = form.at(topology.mouth(7, column)).y();
      const double edge = parting + 0.5 * (fold - parting);
      form.place(topology.mouth(8, column), wall(inner_angle[c], middle + (edge - middle) * inner_rise[c], 0), 1e4);
      form.place(topology.mouth(9, column),
                 wall(sulcus_angle[c], middle + (fold - middle) * sulcus_rise[c], fold_depth), 1e4);
      // Roof and floor: inwards and back; the cheek columns go straight back.
      const double side = c / 8.0;
      const double palate = upper ? top + 3.5 : bottom + 1.5, rear = upper ? top - 3 : bottom + 7;
      const double x9 = half_width * (0.10 + 0.92 * side) * std::min(1.0, side * 8),
                   x10 = half_width * (0.06 + 0.82 * side) * std::min(1.0, side * 8);
      const double rise9 = std::sqrt(1 - std::pow(side, 7)), rise10 = std::sqrt(1 - std::pow(side, 5));
      form.place(topology.mouth(10, column), {x9, middle + (palate - middle) * rise9, z0 + 17 - 14 * side}, 1e4);
      form.place(topology.mouth(11, column), {x10, middle + (rear - middle) * rise10, z0 - 4 - 4.5 * side}, 1e4);
    }
  for (int u = 0; u < 7; ++u) {
    const double side = u / 8.0;
    form.place(topology.throat(u, 1),
               {half_width * (0.06 + 0.82 * side) * std::min(1.0, side * 8), middle, z0 - 10 + side}, 1e4);
  }
  for (int ring = 9; ring <= SkinTopology::mouth_rings; ++ring)
    for (int c = 0; c <= 16; ++c) form.keep_control(topology.mouth(ring, c));
}

}  // namespace phiz
