// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "phiz/anatomy/builtin/skin/form.h"

namespace phiz {
namespace {

constexpr int half = 9;  // columns from the midline to the corner of the mouth

/// A ring round the mouth of the mean head: upper and lower half from the midline to the corner, millimetres.
struct LipRing {
  int ring;
  double firmness;
  double x_upper[half], y_upper[half], z_upper[half];
  double x_lower[half], y_lower[half], z_lower[half];
};

constexpr LipRing rings[] = {
    // Between nose and lip, and above the chin.
    {1,
     1,
     {0, 3.59, 6.95, 11.47, 16.15, 21.39, 26.39, 29.8, 31.82},
     {-21.8, -21.4, -21.2, -21.4, -22.4, -24.4, -27.7, -32, -38},
     {83.3, 83.7, 83.8, 82.4, 80.1, 77.4, 74.6, 72.9, 71.9},
     {0, 3.29, 6.55, 10.28, 14.38, 18.84, 24.44, 29.21, 31.82},
     {-52.5, -52.5, -52.5, -52.3, -51.7, -50.7, -48.2, -44, -38},
     {79.6, 79.6, 79.4, 78.8, 77.8, 76.3, 74, 72.6, 71.9}},
    // White roll just outside the vermilion.
    {2,
     30,
     {0, 3.5, 6.85, 11.15, 15.7, 20, 23.5, 26, 27.7},
     {-28.3, -26.8, -26.5, -27.7, -29.6, -31.6, -33.9, -36.2, -38.2},
     {85.7, 85.9, 85.5, 83.8, 81.6, 79.2, 76.8, 74.9, 73.3},
     {0, 3.47, 6.88, 10.81, 15.05, 19.32, 23.12, 26.1, 28.27},
     {-48.8, -48.8, -48.6, -47.8, -46.6, -44.8, -42.7, -40.5, -38.2},
     {82.9, 82.8, 82.5, 81.6, 80.2, 78.6, 76.7, 74.9, 73.3}},
    // Vermilion border.
    {3,
     100,
     {0, 3.57, 6.88, 11.1, 15.44, 19.51, 22.74, 24.97, 26.41},
     {-30.6, -29.2, -28.8, -30, -31.8, -33.5, -35.3, -36.9, -38.1},
     {87.5, 87.9, 87.5, 85.6, 83.2, 80.6, 78.1, 75.8, 73.8},
     {0, 3.57, 7.17, 11.1, 15.25, 19.12, 22.36, 24.78, 26.41},
     {-46.6, -46.6, -46.4, -45.7, -44.4, -42.7, -41, -39.5, -38.1},
     {86.2, 86.1, 85.7, 84.4, 82.5, 80.3, 78, 75.8, 73.8}},
    // Fullest line of the vermilion.
    {4,
     40,
     {0, 3.57, 7.27, 11.39, 15.44, 19.22, 22.36, 24.5, 25.85},
     {-34.2, -33.1, -32.5, -33.1, -34.1, -35.2, -36.4, -37.2, -38},
     {88.8, 88.4, 87.5, 85.7, 83.4, 80.9, 78.3, 75.9, 73.8},
     {0, 3.57, 7.37, 11.39, 15.34, 19.03, 22.17, 24.41, 25.85},
     {-42.7, -42.7, -42.6, -42.2, -41.5, -40.6, -39.6, -38.7, -38},
     {87.9, 88, 87.7, 86.3, 84.1, 81.3, 78.4, 75.9, 73.8}},
    // Edge where the vermilion turns inwards.
    {5,
     60,
     {0, 3.57, 7.27, 11.2, 15.05, 18.74, 21.7, 23.84, 25.2},
     {-36.6, -36.2, -35.7, -35.7, -36, -36.5, -37.05, -37.55, -38},
     {87, 86.7, 86, 84.5, 82.5, 80.3, 77.9, 75.5, 73.4},
     {0, 3.57, 7.27, 11.2, 15.05, 18.74, 21.7, 23.84, 25.2},
     {-39, -38.7, -38.2, -38.1, -38.2, -38.3, -38.3, -38.2, -38},
     {86.2, 86.1, 85.6, 84.2, 82.2, 80.1, 77.7, 75.4, 73.4}},
};
/// The parting of the lips, front to back: where upper and lower lip face each other.
constexpr double parting_x[half] = {0, 3.55, 7.2, 10.94, 14.56, 17.9, 20.59, 22.56, 23.66};
constexpr double parting_y[half] = {-37.7, -37.4, -36.9, -36.8, -37, -37.3, -37.6, -37.8, -38};
constexpr double parting_z[half] = {85.2, 85.1, 84.5, 83.2, 81.4, 79.3, 77, 74.7, 72.6};
constexpr double parting_back_z[half] = {76.2, 75.8, 75, 73.6, 71.4, 68.4, 64.6, 60.4, 57};
constexpr double back_half_gap = 0.07;  // of the control vertices behind, where the lining pulls the lips apart
/// Between the limit surfaces in front. The control vertices there overlap, for those before and behind pull apart.
constexpr double front_gap = 0.26;
constexpr double back_rise = 0.6;  // the slit rises inwards, so that nobody sees through it

}  // namespace

void place_lips(SkinForm& form) {
  const SkinTopology& topology = skin_topology();
  for (const LipRing& ring : rings)
    for (int c = 0; c < half; ++c) {
      form.place(topology.mouth(ring.ring, c), {ring.x_upper[c], ring.y_upper[c], ring.z_upper[c]}, ring.firmness);
      form.place(topology.mouth(ring.ring, 16 - c), {ring.x_lower[c], ring.y_lower[c], ring.z_lower[c]}, ring.firmness);
    }
  const LipRing& edge = rings[4];
  for (int c = 0; c < half; ++c)
    for (const double side : {1.0, -1.0}) {
      const int column = side > 0 ? c : 16 - c;
      const double open = c == half - 1 ? 0 : side, inset = 1 - 0.06 * c / (half - 1);
      const double edge_gap = edge.y_upper[c] - edge.y_lower[c];
      const double front_half_gap = std::min(back_half_gap, 0.125 * (6 * front_gap - edge_gap - 2 * back_half_gap));
      form.place(topology.mouth(6, column), {parting_x[c], parting_y[c] + open * front_half_gap, parting_z[c]}, 1e4);
      form.place(
          topology.mouth(7, column),
          {parting_x[c] * inset, parting_y[c] + open * back_half_gap + back_rise * std::abs(open), parting_back_z[c]},
          1e4);
    }
  for (int ring = 5; ring <= 7; ++ring)
    for (int c = 0; c <= 16; ++c) form.keep_control(topology.mouth(ring, c));
}

}  // namespace phiz
