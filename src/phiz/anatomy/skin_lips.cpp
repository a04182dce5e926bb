// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/skin_form.h"

namespace phiz {
namespace {

constexpr int half = 9;  // columns from the midline to the corner of the mouth

/// A ring round the mouth of the mean head: upper and lower half from the midline to the corner, millimetres.
struct LipRing {
  int ring;
  double x_upper[half], y_upper[half], z_upper[half];
  double x_lower[half], y_lower[half], z_lower[half];
};

constexpr LipRing rings[] = {
    // Between nose and lip, and above the chin.
    {1,
     {0, 3.6, 7, 11.6, 16.4, 21.8, 27, 30.6, 32.6},
     {-20.5, -20.3, -20.2, -20.6, -21.8, -24, -27.5, -32, -38},
     {84.4, 85, 84.9, 83.4, 81, 78, 74.8, 73.2, 71.8},
     {0, 3.3, 6.6, 10.4, 14.6, 19.2, 25, 30, 32.6},
     {-53, -53, -53, -52.8, -52.2, -51.2, -48.5, -44, -38},
     {80, 80, 79.8, 79.3, 78.4, 76.8, 74.2, 72.6, 71.8}},
    // White roll just outside the vermilion.
    {2,
     {0, 3.4, 6.9, 11.5, 16.5, 21.3, 25.4, 28.4, 30.2},
     {-27.8, -27, -26.8, -27.6, -29.2, -31.3, -33.8, -36.2, -38.2},
     {86.2, 86.8, 86.5, 85.1, 82.9, 80.3, 77.4, 75.1, 73.4},
     {0, 3.5, 7, 11.1, 15.6, 20.2, 24.4, 27.8, 30.2},
     {-49.3, -49.3, -49.1, -48.5, -47.4, -45.7, -43.4, -40.8, -38.2},
     {83, 82.9, 82.6, 81.8, 80.6, 78.9, 76.7, 74.9, 73.4}},
    // Vermilion border.
    {3,
     {0, 3.6, 7, 11.4, 16, 20.4, 24, 26.6, 28.4},
     {-30.6, -29.6, -29.4, -30.4, -31.9, -33.6, -35.4, -36.9, -38.1},
     {87.8, 88.1, 87.6, 85.9, 83.6, 81, 78.4, 76.1, 74},
     {0, 3.6, 7.3, 11.4, 15.8, 20, 23.6, 26.4, 28.4},
     {-46.2, -46.2, -46, -45.4, -44.3, -42.7, -41, -39.4, -38.1},
     {85.6, 85.5, 85, 83.9, 82.3, 80.3, 78, 75.9, 74}},
    // Fullest line of the vermilion.
    {4,
     {0, 3.6, 7.5, 11.7, 15.9, 19.9, 23.3, 25.8, 27.4},
     {-35.2, -34.8, -34.4, -34.5, -35, -35.8, -36.6, -37.3, -38},
     {88.6, 88.4, 87.7, 86.2, 84.1, 81.6, 78.8, 76, 73.6},
     {0, 3.6, 7.5, 11.7, 15.9, 19.9, 23.3, 25.8, 27.4},
     {-40.9, -40.8, -40.7, -40.4, -39.9, -39.3, -38.8, -38.4, -38},
     {87.4, 87.2, 86.6, 85.4, 83.5, 81.1, 78.5, 76, 73.6}},
};
/// The parting of the lips, front to back: where upper and lower lip face each other.
constexpr double parting_x[half] = {0, 3.6, 7.4, 11.4, 15.4, 19.2, 22.4, 24.9, 26.5};
constexpr double parting_y[half] = {-37.7, -37.4, -36.9, -36.8, -37, -37.3, -37.6, -37.8, -38};
constexpr double parting_z[half] = {85.7, 85.6, 85, 83.7, 81.9, 79.7, 77.2, 74.8, 72.6};
constexpr double parting_back_z[half] = {76.2, 75.8, 75, 73.6, 71.4, 68.4, 64.6, 60.4, 57};
constexpr double half_gap = 0.07;  // of the control vertices; the limit surface opens to about three times as much

}  // namespace

void place_lips(SkinForm& form) {
  const SkinTopology& topology = skin_topology();
  for (const LipRing& ring : rings)
    for (int c = 0; c < half; ++c) {
      form.place(topology.mouth(ring.ring, c), {ring.x_upper[c], ring.y_upper[c], ring.z_upper[c]}, 4);
      form.place(topology.mouth(ring.ring, 16 - c), {ring.x_lower[c], ring.y_lower[c], ring.z_lower[c]}, 4);
    }
  for (int c = 0; c < half; ++c)
    for (const double side : {1.0, -1.0}) {
      const int column = side > 0 ? c : 16 - c;
      const double gap = c == half - 1 ? 0 : side * half_gap;
      const double inset = 1 - 0.06 * c / (half - 1);
      form.place(topology.mouth(5, column), {parting_x[c], parting_y[c] + gap, parting_z[c]}, 1e4);
      form.place(topology.mouth(6, column), {parting_x[c] * inset, parting_y[c] + gap, parting_back_z[c]}, 1e4);
    }
  for (int ring = 4; ring <= 6; ++ring)
    for (int c = 0; c <= 16; ++c) form.keep_control(topology.mouth(ring, c));
}

}  // namespace phiz
