// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/mouth/tongue.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "phiz/anatomy/builtin/mouth/loft.h"

namespace phiz {
namespace {

/// A cross-section of the tongue, metres: the place of its margins (y, z), how far the margins reach to the side, how
/// far the back of the tongue rises over them and its belly hangs below them, and how deep the median groove is.
struct TongueSection {
  double y, z, half_width, rise, belly, groove;

  TongueSection operator+(const TongueSection& o) const {
    return {y + o.y, z + o.z, half_width + o.half_width, rise + o.rise, belly + o.belly, groove + o.groove};
  }
  TongueSection operator*(double t) const { return {t * y, t * z, t * half_width, t * rise, t * belly, t * groove}; }
};
using Sections = std::array<TongueSection, 6>;  // root, back, dorsum, front, blade, tip

/// Catmull-Rom between the sections at u in [0, 1].
TongueSection section_at(const Sections& s, double u) {
  const double x = u * (s.size() - 1);
  const int last = static_cast<int>(s.size()) - 1, i = std::min(static_cast<int>(x), last - 1);
  const TongueSection &a = s[static_cast<std::size_t>(std::max(i - 1, 0))], &b = s[static_cast<std::size_t>(i)],
                      &c = s[static_cast<std::size_t>(i + 1)], &d = s[static_cast<std::size_t>(std::min(i + 2, last))];
  const double t = x - i;
  return b + (c + a * -1) * (0.5 * t) + (a * 2 + b * -5 + c * 4 + d * -1) * (0.5 * t * t) +
         (b * 3 + c * -3 + d + a * -1) * (0.5 * t * t * t);
}

std::vector<MatrixX3d> rings(const Sections& sections) {
  constexpr int along = 34, round = 36;
  std::vector<MatrixX3d> all;
  for (int k = 0; k < along; ++k) {
    // Rings gather at both ends, where the section closes: round in plan, so that the tip is a tip.
    const double u = 0.5 * (1 - std::cos(std::numbers::pi * (k + 0.3) / (along - 0.4)));
    const TongueSection here = section_at(sections, u);
    const TongueSection before = section_at(sections, std::max(u - 0.02, 0.0)),
                        after = section_at(sections, std::min(u + 0.02, 1.0));
    const Vector2d direction = Vector2d(after.z - before.z, after.y - before.y).normalized();
    const auto closing = [](double from_end, double over) {
      return std::sqrt(std::max(0.0, 1 - std::pow(1 - std::min(from_end / over, 1.0), 2)));
    };
    const double plan = closing(u, 0.10) * closing(1 - u, 0.22), side = closing(u, 0.10) * closing(1 - u, 0.10);
    MatrixX3d ring(round, 3);
    for (int i = 0; i < round; ++i) {
      const double a = 2 * std::numbers::pi * i / round, c = std::cos(a), s = std::sin(a);
      double up = s > 0 ? here.rise * std::pow(s, 0.85) : here.belly * s;
      if (s > 0) up -= here.groove * std::exp(-std::pow(c / 0.2, 2)) * s;
      const double waist = s < 0 ? 1 - 0.28 * s * s : 1;  // the belly is narrower than the back
      ring.row(i) << here.half_width * plan * waist * std::copysign(std::pow(std::abs(c), 0.9), c),
          here.y + side * up * direction.x(), here.z - side * up * direction.y();
    }
    all.push_back(ring);
  }
  return all;
}

}  // namespace

Part make_tongue(const Proportions& p) {
  const Proportions::DentalArch& a = p.arch;
  const double mm = 1e-3, width = a.half_width / 0.029, front = a.z0 + a.depth, back = a.z0, y = a.lower_edge;
  const auto section = [&](double up, double z, double half_width, double rise, double belly, double groove) {
    return TongueSection{y + up * mm, z, half_width * mm * width, rise * mm, belly * mm, groove * mm};
  };
  // At rest: the back high under the palate, the margins along the lower teeth, the tip behind the lower incisors.
  const Sections rest{
      {section(-6, back - 3 * mm, 12.6, 8.0, 12.0, 0.2), section(-2.5, back + 5 * mm, 14.6, 9.5, 13.0, 0.8),
       section(-2, back + 0.36 * a.depth, 14.0, 8.0, 12.0, 1.3),
       section(-3, back + 0.56 * a.depth, 12.0, 5.8, 8.0, 1.3), section(-4.2, front - 14.5 * mm, 9.4, 3.8, 4.6, 0.9),
       section(-4.4, front - 9.0 * mm, 6.6, 2.4, 2.0, 0.3)}};
  // Put out: over the lower incisors, then down over the lip, flatter and hollowed along the middle.
  const Sections out{
      {section(-6, back, 12.5, 8.0, 12.0, 0.2), section(-1, back + 0.30 * a.depth, 13.6, 8.0, 10.0, 0.8),
       section(3.4, front - 12 * mm, 13.0, 4.4, 4.6, 1.6), section(3.4, front + 3 * mm, 12.4, 3.4, 3.4, 1.9),
       section(-1.2, front + 16 * mm, 11.6, 3.0, 2.8, 1.6), section(-9.5, front + 25 * mm, 9.0, 2.3, 2.0, 0.6)}};
  Part tongue;
  tongue.name = "tongue";
  tongue.carrier = Carrier::mandible;
  tongue.mesh = loft(rings(rest));
  tongue.shapes["tongueOut"] = loft_vertices(rings(out)) - tongue.mesh.V;
  return tongue;
}

}  // namespace phiz
