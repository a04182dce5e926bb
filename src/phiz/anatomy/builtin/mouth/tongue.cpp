// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/mouth/tongue.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "phiz/anatomy/builtin/mouth/loft.h"

namespace phiz {
namespace {

/// A cross-section of the tongue: place of its middle (y, z) and its half width and half height, metres.
struct Section {
  double y, z, half_width, half_height;
};
using Sections = std::array<Section, 5>;  // root, back, middle, blade, tip

double hermite(double a, double b, double c, double d, double t) {
  return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
}

/// Catmull-Rom between the sections at u in [0, 1].
Section section_at(const Sections& s, double u) {
  const double x = u * (s.size() - 1);
  const auto i = std::min(static_cast<int>(x), static_cast<int>(s.size()) - 2);
  const int last = static_cast<int>(s.size()) - 1;
  const Section &a = s[std::max(i - 1, 0)], &b = s[i], &c = s[i + 1], &d = s[std::min(i + 2, last)];
  const double t = x - i;
  return {hermite(a.y, b.y, c.y, d.y, t), hermite(a.z, b.z, c.z, d.z, t),
          hermite(a.half_width, b.half_width, c.half_width, d.half_width, t),
          hermite(a.half_height, b.half_height, c.half_height, d.half_height, t)};
}

std::vector<MatrixX3d> rings(const Sections& sections) {
  constexpr int along = 26, round = 28;
  std::vector<MatrixX3d> all;
  for (int k = 0; k < along; ++k) {
    // Rings gather at both ends, where the section closes like an ellipsoid.
    const double angle = std::numbers::pi * (k + 0.35) / (along - 0.3);
    const double u = 0.5 * (1 - std::cos(angle));
    const Section here = section_at(sections, u);
    const Section before = section_at(sections, std::max(u - 0.02, 0.0)),
                  after = section_at(sections, std::min(u + 0.02, 1.0));
    const Vector2d direction = Vector2d(after.z - before.z, after.y - before.y).normalized();
    const double from_end = std::min(u, 1 - u);
    const double closing = std::sqrt(std::max(0.0, 1 - std::pow(1 - std::min(from_end / 0.16, 1.0), 2)));
    MatrixX3d ring(round, 3);
    for (int i = 0; i < round; ++i) {
      const double a = 2 * std::numbers::pi * i / round, c = std::cos(a), s = std::sin(a);
      const double r = std::pow(std::pow(std::abs(c), 2.6) + std::pow(std::abs(s), 2.6), -1 / 2.6);
      const double x = here.half_width * closing * r * c;
      double up = here.half_height * closing * r * s;
      // Median groove on the upper face, deepest in the middle of the tongue.
      if (s > 0)
        up -= 0.10 * here.half_height * closing * std::exp(-std::pow(c / 0.22, 2)) * std::sin(std::numbers::pi * u);
      ring.row(i) << x, here.y + up * direction.x(), here.z - up * direction.y();
    }
    all.push_back(ring);
  }
  return all;
}

}  // namespace

Part make_tongue(const Proportions& p) {
  const Proportions::DentalArch& a = p.arch;
  const double mm = 1e-3, width = a.half_width / 0.029, front = a.z0 + a.depth;
  const double y = a.lower_edge;
  const Sections rest{{{y - 9.0 * mm, a.z0 - 2 * mm, 11.5 * mm * width, 9.0 * mm},
                       {y - 5.0 * mm, a.z0 + 5 * mm, 14.0 * mm * width, 9.5 * mm},
                       {y - 5.5 * mm, a.z0 + 0.42 * a.depth, 13.6 * mm * width, 8.0 * mm},
                       {y - 7.5 * mm, front - 19 * mm, 10.8 * mm * width, 5.6 * mm},
                       {y - 7.8 * mm, front - 13.5 * mm, 7.6 * mm * width, 3.6 * mm}}};
  // Put out: over the lower incisors, then down over the lip, flatter and a little narrower.
  const Sections out{{{y - 9.0 * mm, a.z0 + 1 * mm, 11.0 * mm * width, 8.5 * mm},
                      {y - 2.5 * mm, a.z0 + 0.40 * a.depth, 12.6 * mm * width, 7.0 * mm},
                      {y + 3.6 * mm, front - 5 * mm, 11.8 * mm * width, 4.0 * mm},
                      {y - 1.5 * mm, front + 12 * mm, 11.0 * mm * width, 3.6 * mm},
                      {y - 10.0 * mm, front + 23 * mm, 7.8 * mm * width, 2.8 * mm}}};
  Part tongue;
  tongue.name = "tongue";
  tongue.carrier = Carrier::mandible;
  tongue.mesh = loft(rings(rest));
  tongue.shapes["tongueOut"] = loft_vertices(rings(out)) - tongue.mesh.V;
  return tongue;
}

}  // namespace phiz
