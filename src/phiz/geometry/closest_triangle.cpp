// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "phiz/geometry/spatial_query.h"

namespace phiz {

namespace {

/// Parameter of the point of the segment a + s ab closest to a + ap.
double closest_on_segment(const Vector3d& ap, const Vector3d& ab) {
  const double length = ab.squaredNorm();
  return length > 0 ? std::clamp(ap.dot(ab) / length, 0.0, 1.0) : 0.0;
}

}  // namespace

Vector3d closest_barycentric(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const Vector3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const Vector3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const double s = closest_on_segment(ap, ab);
    return {1 - s, s, 0};
  }
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const double s = closest_on_segment(ap, ac);
    return {1 - s, 0, s};
  }
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double s = closest_on_segment(bp, c - b);
    return {0, 1 - s, s};
  }
  const double sum = va + vb + vc;
  if (!(sum > 0)) return {1, 0, 0};
  const double v = std::clamp(vb / sum, 0.0, 1.0);
  const double w = std::clamp(vc / sum, 0.0, 1.0 - v);
  return {1 - v - w, v, w};
}

}  // namespace phiz
