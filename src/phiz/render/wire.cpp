// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/render/wire.h"

#include <algorithm>

namespace phiz::detail {

float wire_coverage(const Lens& lens, const ShadedPoint& point, float x, float y) {
  const TracedSurface& s = *point.surface;
  const unsigned edges = s.wireframe.edges.empty() ? 7U : s.wireframe.edges[point.triangle];
  const auto& t = s.triangle[point.triangle];
  const Eigen::Vector2f here(x, y);
  float nearest = 1e9F, length = 0;
  int drawn = 0;
  for (int k = 0; k < 3; ++k) {
    if ((edges >> k & 1U) == 0) continue;
    const Eigen::Vector2f a = lens.pixel(s.position[t[k]].head<3>());
    const Eigen::Vector2f b = lens.pixel(s.position[t[(k + 1) % 3]].head<3>());
    const Eigen::Vector2f ab = b - a;
    const float along = std::clamp((here - a).dot(ab) / std::max(ab.squaredNorm(), 1e-12F), 0.F, 1.F);
    nearest = std::min(nearest, (here - a - along * ab).norm());
    length += ab.norm();
    ++drawn;
  }
  if (drawn == 0) return 0;
  // Lines of a dense mesh get thinner than asked for, so that the surface between them stays visible.
  const float width = std::min(static_cast<float>(s.wireframe.width), 0.13F * length / static_cast<float>(drawn));
  const float strength = std::min(width, 1.F), half = std::max(width, 1.F) / 2;
  return strength * std::clamp(half + 0.5F - nearest, 0.F, 1.F);
}

}  // namespace phiz::detail
