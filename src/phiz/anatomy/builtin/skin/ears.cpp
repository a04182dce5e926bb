// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>

#include "phiz/anatomy/builtin/skin/form.h"

namespace phiz {
namespace {

constexpr int n = SkinTopology::ear_columns;

/// Where the auricle leaves the head, in its own plane (a backwards, b upwards) and the x of the head there;
/// millimetres.
constexpr double rim_a[n] = {0, -1.5, -1.5, -1.5, -1.5, -1.5, -0.5, 3.5, 9, 15, 20, 22.5, 22, 20, 15.2, 7.3};
constexpr double rim_b[n] = {-22, -15.5, -9, -3, 3, 10, 18, 23, 24.5, 23.2, 19.2, 12.5, 4, -4.5, -14, -22.5};
constexpr double rim_x[n] = {68, 69.5, 70.4, 71, 71.4, 71.6, 71.6, 71.2, 71, 70.8, 71, 71, 70.4, 69.6, 68, 67};

/// Points of the auricle in its own plane: a backwards, b upwards, h out from the head; millimetres. Columns as in
/// SkinTopology: lobe's front, tragus (2..4), root of the helix (5), top (8), back (11), lobe (15).
struct EarRing {
  int ring;
  double share;  // of the person's flare
  double a[n], b[n], h[n];
};
constexpr EarRing rings[] = {
    // Back of the auricle (columns 7 to 15), foot of the tragus (1 to 5).
    {1,
     1,
     {0.5, -0.5, -0.5, -0.5, -0.5, -0.8, 0.4, 4.2, 11, 18.5, 24.5, 27, 25.5, 21.5, 15.5, 7.5},
     {-20.5, -14, -8.5, -3, 3, 9.5, 17.6, 24.6, 28.8, 28.5, 22, 12.5, 1.5, -8, -17.8, -25},
     {-0.3, 0.6, 0.6, 0.6, 0.6, 0.6, 0.9, 0.6, -1.3, -2.6, -2.8, -2.8, -2.8, -2.6, -3.2, -3.4}},
    // Rim of the helix.
    {2,
     1,
     {1.2, 0.3, 0.6, 1, 0.5, 0, 0.8, 4.5, 12, 21, 28, 30.5, 29, 24.5, 17.6, 8.6},
     {-23.8, -14.5, -8.5, -3, 3, 9, 17.5, 27, 32.5, 31, 24, 13, 1, -9.8, -21.2, -27.6},
     {0.5, 2.2, 3, 3.4, 2.6, 2.4, 3.2, 2.6, 1.2, 0.6, 0.4, 0.4, 0.4, 0.2, -2, -3.6}},
    // Front edge of the helix, crest of the tragus.
    {3,
     1,
     {3.4, 3, 4.2, 5, 3.6, 2.4, 3.4, 7, 13, 20, 25.6, 27.6, 26.2, 22.4, 16.5, 9},
     {-20, -13, -8, -3, 2.6, 9, 17, 24.5, 28.8, 27.4, 21.4, 12, 1, -8.5, -18, -24.5},
     {1.9, 3.4, 5, 5.6, 4.2, 4.2, 5, 4.8, 4.2, 3.8, 3.6, 3.5, 3.4, 3, 1, -0.2}},
    // Groove behind the helix.
    {4,
     1,
     {5, 5, 5.8, 6.4, 5.4, 4.6, 5.6, 8.6, 13.2, 18.6, 22.8, 24.4, 23.2, 20, 15, 9.4},
     {-17, -12, -7.5, -3, 2, 7.5, 14.5, 21, 24.6, 23.4, 18.4, 10.4, 0.8, -7.4, -15.5, -20.5},
     {1.8, 1, 3.2, 3.8, 2.4, 1.6, 1.8, 1.2, 0.4, 0, 0, 0, 0.2, 0.6, 0.6, 0.4}},
    // Crest of the antihelix, antitragus (14, 15).
    {5,
     0.7,
     {6.8, 6.6, 6.6, 6.8, 6.6, 6.8, 8.2, 10.4, 13.2, 16.2, 18.6, 19.4, 18.8, 16.8, 13.2, 9.8},
     {-13.2, -10.5, -7, -3, 1.4, 5.6, 10.2, 14.6, 17.4, 16.6, 13.2, 7.6, 0.4, -6, -11.8, -14.6},
     {1.6, -1.5, -1, 0, -1, -1.2, 0.2, 1.6, 2.4, 3, 3.4, 3.6, 3.6, 3.2, 3.2, 3.1}},
    // Edge of the concha's floor.
    {6,
     0.2,
     {8.2, 7.8, 7.4, 7.2, 7.4, 8, 9.2, 10.8, 12.6, 14.2, 15.2, 15.4, 14.8, 13.4, 11.4, 9.6},
     {-10.2, -8.6, -6, -2.8, 0.8, 4, 7.2, 9.6, 10.6, 10, 7.8, 4.4, 0, -4.4, -8, -10.2},
     {-3.4, -4.4, -4.8, -4.8, -4.6, -4, -3.4, -3, -2.8, -2.8, -3, -3.2, -3.4, -3.4, -3.2, -3}},
};

}  // namespace

void place_ears(SkinForm& form, const IdentityParameters& identity) {
  const SkinTopology& topology = skin_topology();
  const double tilt = 14 * M_PI / 180, size = 1 + 0.065 * identity.ear_size;
  const Vector3d up(0.04, std::cos(tilt), -std::sin(tilt)), origin(70.2, 4, -10.5);
  // `share` of the person's flare: the root and the bottom of the concha stay with the head.
  const auto point = [&](double a, double b, double h, double share) -> Vector3d {
    const double flare = (28 + 3.6 * share * identity.ear_flare) * M_PI / 180;
    Vector3d back(std::sin(flare), -std::sin(tilt) * std::cos(flare), -std::cos(tilt) * std::cos(flare));
    back = (back - back.dot(up) / up.squaredNorm() * up).normalized();
    const Vector3d out = back.cross(up).normalized();
    return origin + size * (a * back + b * up + h * out);
  };
  for (int c = 0; c < n; ++c) {
    const Vector3d p = point(rim_a[c], rim_b[c], 0, 0);
    form.place(topology.ear(0, c), {rim_x[c], p.y(), p.z()}, 0.1);
  }
  for (const EarRing& ring : rings)
    for (int c = 0; c < n; ++c)
      form.place(topology.ear(ring.ring, c), point(ring.a[c], ring.b[c], ring.h[c], ring.share), 20);
  for (int u = 1; u < 4; ++u)
    for (int v = 1; v < 4; ++v)
      form.place(topology.concha(u, v), point(8.6 + 1.6 * u, -8.5 + 4.2 * v, -5.6 - 0.4 * (2 - std::abs(u - 2)), 0.2),
                 20);
}

}  // namespace phiz
