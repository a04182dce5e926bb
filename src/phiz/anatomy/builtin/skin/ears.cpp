// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>

#include "phiz/anatomy/builtin/skin/cranium.h"
#include "phiz/anatomy/builtin/skin/form.h"

namespace phiz {
namespace {

constexpr int n = SkinTopology::ear_columns;

/// A point of the auricle in its own plane, millimetres: a backwards, b upwards, h out from the head.
struct EarPoint {
  double a, b, h;
};

/// From the head (ring 0, whose h is not used) over the back of the auricle or the slope of the tragus to the rim
/// (ring 3), the front edge of the helix or of the tragus (4), the scapha (5), the antihelix (6) and down into the
/// concha (8).
constexpr EarPoint auricle[n][SkinTopology::ear_rings + 1] = {
    // 0: lobe, its front
    {{-5, -27, 0},
     {-0.6, -27.4, -1.3},
     {4, -30, -1.3},
     {8, -31, 0.8},
     {6.4, -26.4, 2.6},
     {5, -20.5, 2.5},
     {6.4, -15.4, 1},
     {7.6, -12, -2.5},
     {8.3, -9.8, -5}},
    // 1: below the notch before the concha
    {{-9, -17, 0},
     {-3.6, -17.8, 0.2},
     {-0.6, -18.4, 0.9},
     {1.8, -17.6, 1.4},
     {3.2, -15.6, 1.2},
     {4.6, -13.8, 0.2},
     {6.4, -12.2, -0.8},
     {7.2, -10, -3.5},
     {8, -8.4, -5.5}},
    // 2 to 4: tragus
    {{-9.5, -9.3, 0},
     {-3.2, -9.5, 0.7},
     {-0.6, -9.4, 1.8},
     {1.6, -9.1, 3},
     {3.6, -8.6, 3},
     {4.8, -8.2, 1},
     {5.8, -7.6, -1.8},
     {6.8, -6.8, -4.2},
     {8, -5.8, -5.2}},
    {{-9.5, -2.5, 0},
     {-3, -2.5, 0.9},
     {0.2, -2.7, 2.6},
     {3.4, -3, 4.6},
     {6.4, -3.4, 4.8},
     {6.8, -3.4, 2.4},
     {6.6, -3.2, -1.6},
     {7.2, -2.9, -4.2},
     {8.4, -2.5, -5.4}},
    {{-9, 4, 0},
     {-3, 3.8, 0.7},
     {-0.6, 3.3, 1.8},
     {1.6, 2.6, 3},
     {3.8, 2, 2.6},
     {4.6, 1.6, 0.4},
     {5.6, 1.4, -2},
     {6.8, 1.2, -4},
     {8.2, 1.2, -4.8}},
    // 5: root of the helix, which runs into the concha
    {{-8, 10.5, 0},
     {-2.6, 9.9, 0.6},
     {-0.6, 9.5, 1.3},
     {1.2, 8.9, 2.1},
     {3.4, 7.9, 2.5},
     {6, 6.6, 1.9},
     {7.6, 5.6, 0.2},
     {8.6, 5, -2},
     {9, 4.4, -3.6}},
    {{-6.5, 17.5, 0},
     {-1.8, 16.8, 0},
     {0, 17.2, 1.3},
     {1.6, 17.6, 3.1},
     {4.2, 16.4, 4.8},
     {6.2, 14.2, 1.2},
     {7.4, 11.8, 0},
     {8, 9.8, -1.6},
     {8.4, 7.4, -3.4}},
    {{-1.5, 25, 0},
     {2.6, 26.4, -1},
     {4.4, 26.8, 0.2},
     {5.9, 27.2, 2},
     {7.2, 24.6, 4.8},
     {8.6, 20.4, 1},
     {9.6, 16, 0.8},
     {9.6, 12.8, 1.4},
     {9.4, 9.6, -2.6}},
    // 8: top
    {{4.5, 30, 0},
     {9, 30.3, -2.2},
     {11.8, 31.6, -0.9},
     {13, 31.3, 1.4},
     {12.6, 28.6, 4.4},
     {12.6, 23.6, 0.6},
     {13, 18.5, 0.2},
     {11.8, 13.6, 1.6},
     {11, 10.2, -2.8}},
    {{13, 33, 0},
     {17, 28, -2.8},
     {20.6, 27.2, -2.2},
     {22.7, 29.6, 0.6},
     {20.6, 27.2, 3.8},
     {17.8, 22.8, 0.4},
     {16.3, 18.2, 2},
     {13.9, 13.2, 0.6},
     {12.7, 10, -3.2}},
    {{22.5, 25.5, 0},
     {21.3, 18.3, -2.2},
     {27, 20.8, -3.2},
     {30, 22, 0},
     {27.6, 20.8, 3.4},
     {23, 17.7, -0.2},
     {19.4, 14.3, 2.9},
     {16, 10.8, -0.4},
     {14.2, 8.4, -3.8}},
    // 11: back
    {{26, 14, 0},
     {23.5, 11.5, -2.6},
     {29.8, 11.2, -3.8},
     {33, 10.5, -0.6},
     {30.3, 10.2, 3},
     {25.2, 9.3, -0.2},
     {20.8, 8.2, 3.4},
     {17, 6.3, -0.4},
     {15, 4.8, -4.2}},
    {{22.5, 3.5, 0},
     {22.3, 2.6, -2.6},
     {28, 0.5, -3.6},
     {31.2, -1, -0.8},
     {28.6, -0.3, 2.7},
     {24, 0.3, 0},
     {19.8, 0.6, 3.6},
     {16.4, 0.6, -0.6},
     {14.6, 0.4, -4.4}},
    {{18, -5, 0},
     {19.5, -6, -2.2},
     {23.5, -8.5, -3},
     {26.2, -11.3, -0.6},
     {23.8, -10, 2.2},
     {20.6, -8.5, 0.4},
     {17.2, -7, 3.4},
     {14.6, -5.3, -0.8},
     {13.2, -4.2, -4.6}},
    // 14, 15: antitragus, lobe
    {{13.5, -13, 0},
     {14.8, -15, -1.8},
     {18.4, -17.9, -2.2},
     {21.4, -20.5, 0},
     {19, -18.8, 1.8},
     {15.3, -16, 1.6},
     {13.2, -12.4, 3.3},
     {11.8, -9.6, -1.2},
     {11.2, -8, -4.6}},
    {{5, -22, 0},
     {8, -22, -1.5},
     {13, -25.8, -1.5},
     {16.2, -28.2, 0.2},
     {13.6, -25.2, 2.3},
     {10.2, -20, 2.4},
     {9.8, -14.2, 3.2},
     {9.6, -11.3, -1.5},
     {9.6, -9.6, -4.8}}};
/// How much of a person's flare the rings take: the root and the bottom of the concha stay with the head.
constexpr double flare_share[SkinTopology::ear_rings + 1] = {0, 0.75, 1, 1, 1, 1, 0.7, 0.4, 0.2};
/// Half the width of the head along the root before the ear; behind it the root lies on the cranium.
constexpr int root_before = 8;
constexpr double root_x[root_before] = {64.8, 66.8, 68.2, 69.1, 69.7, 70.2, 70.8, 71.7};
constexpr double meatus = 1.5;  // how much deeper the middle of the concha lies than its edge

}  // namespace

void place_ears(SkinForm& form, const IdentityParameters& identity) {
  const SkinTopology& topology = skin_topology();
  const double tilt = 14 * M_PI / 180, size = 1 + 0.065 * identity.ear_size;
  const Vector3d up(0.09, std::cos(tilt), -std::sin(tilt)), origin(70.2, 4, -10.5);
  const auto point = [&](const EarPoint& p, double share) -> Vector3d {
    const double flare = (25.5 + 3.1 * share * identity.ear_flare) * M_PI / 180;
    Vector3d back(std::sin(flare), -std::sin(tilt) * std::cos(flare), -std::cos(tilt) * std::cos(flare));
    back = (back - back.dot(up) / up.squaredNorm() * up).normalized();
    const Vector3d out = back.cross(up).normalized();
    return origin + size * (p.a * back + p.b * up + p.h * out);
  };
  for (int c = 0; c < n; ++c) {
    const Vector3d root = point(auricle[c][0], 0);
    const double x = c < root_before ? root_x[c] : cranium_half_width(root.y(), root.z());
    form.place(topology.ear(0, c), {x, root.y(), root.z()}, 0.3);
    for (int ring = 1; ring <= SkinTopology::ear_rings; ++ring)
      form.place(topology.ear(ring, c), point(auricle[c][ring], flare_share[ring]), 20);
  }
  for (int u = 1; u < 4; ++u)
    for (int v = 1; v < 4; ++v) {
      const auto at = [&](int a, int b) { return form.at(topology.concha(a, b)); };
      const Vector3d across = 0.25 * ((4 - u) * at(0, v) + u * at(4, v)),
                     along = 0.25 * ((4 - v) * at(u, 0) + v * at(u, 4));
      const double inside = (u == 2 ? 1 : 0.7) * (v == 2 ? 1 : 0.7);
      form.place(topology.concha(u, v), 0.5 * (across + along) - Vector3d(meatus * inside, 0, 0), 20);
    }
}

}  // namespace phiz
