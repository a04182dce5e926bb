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
     {83.1, 84.5, 84.7, 82.6, 80.1, 77.4, 74.8, 73.2, 72},
     {0, 3.29, 6.55, 10.28, 14.38, 18.84, 24.44, 29.21, 31.82},
     {-52.5, -52.5, -52.5, -52.3, -51.7, -50.7, -48.2, -44, -38},
     {79.7, 79.7, 79.5, 79, 78, 76.5, 74.2, 72.8, 72}},
    // White roll just outside the vermilion.
    {2,
     30,
     {0, 3.5, 6.85, 11.15, 15.7, 20, 23.5, 26, 27.7},
     {-29.2, -27.8, -27.5, -28.7, -30.5, -32.3, -34.4, -36.5, -38.2},
     {86.3, 87.2, 86.9, 84.8, 82.4, 79.8, 77.2, 75.1, 73.4},
     {0, 3.47, 6.88, 10.81, 15.05, 19.32, 23.12, 26.1, 28.27},
     {-48.3, -48.3, -48.1, -47.4, -46.2, -44.5, -42.4, -40.4, -38.2},
     {83.5, 83.4, 83, 82.1, 80.7, 79, 77, 75.1, 73.4}},
    // Vermilion border.
    {3,
     100,
     {0, 3.57, 6.88, 11.1, 15.44, 19.51, 22.74, 24.97, 26.41},
     {-30.7, -29.2, -28.9, -30.2, -31.9, -33.6, -35.4, -36.9, -38.1},
     {87.8, 88.5, 88.1, 86.1, 83.7, 81, 78.3, 75.9, 73.8},
     {0, 3.57, 7.17, 11.1, 15.25, 19.12, 22.36, 24.78, 26.41},
     {-46.4, -46.4, -46.2, -45.5, -44.2, -42.5, -40.9, -39.4, -38.1},
     {86.5, 86.4, 85.9, 84.6, 82.7, 80.4, 78, 75.9, 73.8}},
    // Fullest line of the vermilion.
    {4,
     40,
     {0, 3.57, 7.27, 11.39, 15.44, 19.22, 22.36, 24.5, 25.85},
     {-33.6, -32.4, -31.9, -32.8, -33.9, -35.1, -36.3, -37.2, -38},
     {88.6, 88.5, 87.8, 86, 83.7, 81.1, 78.4, 76, 73.8},
     {0, 3.57, 7.37, 11.39, 15.34, 19.03, 22.17, 24.41, 25.85},
     {-42.6, -42.6, -42.5, -42.1, -41.4, -40.5, -39.5, -38.7, -38},
     {88.2, 88.1, 87.5, 86.1, 84, 81.4, 78.5, 76, 73.8}},
    // Edge where the vermilion turns inwards.
    {5,
     60,
     {0, 3.57, 7.27, 11.2, 15.05, 18.74, 21.7, 23.84, 25.2},
     {-36.6, -36.2, -35.7, -35.7, -36, -36.5, -37.05, -37.55, -38},
     {87.6, 87.4, 86.7, 85.2, 83.2, 80.8, 78.2, 75.7, 73.4},
     {0, 3.57, 7.27, 11.2, 15.05, 18.74, 21.7, 23.84, 25.2},
     {-39, -38.7, -38.2, -38.1, -38.2, -38.3, -38.3, -38.2, -38},
     {86.9, 86.7, 86.1, 84.8, 82.9, 80.6, 78, 75.6, 73.4}},
};
/// The parting of the lips, front to back: where upper and lower lip face each other.
constexpr double parting_x[half] = {0, 3.55, 7.2, 10.94, 14.56, 17.9, 20.59, 22.56, 23.66};
constexpr double parting_y[half] = {-37.7, -37.4, -36.9, -36.8, -37, -37.3, -37.6, -37.8, -38};
constexpr double parting_z[half] = {85.7, 85.6, 85, 83.7, 81.9, 79.7, 77.2, 74.8, 72.6};
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
