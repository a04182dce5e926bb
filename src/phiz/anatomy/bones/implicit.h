// SPDX-License-Identifier: GPL-3.0-or-later
/// Implicit shapes: functions of a point that are negative inside, positive outside and close to the signed distance
/// near their zero set. Any unit of length. Blends after Inigo Quilez's polynomial smooth minimum.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "phiz/geometry/mesh.h"

namespace phiz::implicit {

/// Ellipsoid about `centre` with half axes `radii` (first-order distance).
inline double ellipsoid(const Vector3d& p, const Vector3d& centre, const Vector3d& radii) {
  const Vector3d q = (p - centre).cwiseQuotient(radii);
  const double k0 = q.norm();
  const double k1 = q.cwiseQuotient(radii).norm();
  return k1 > 0 ? k0 * (k0 - 1) / k1 : -radii.minCoeff();
}

/// Capsule from `a` to `b` whose radius goes linearly from `ra` to `rb`.
inline double capsule(const Vector3d& p, const Vector3d& a, const Vector3d& b, double ra, double rb) {
  const Vector3d ab = b - a;
  const double t = std::clamp((p - a).dot(ab) / std::max(ab.squaredNorm(), 1e-30), 0.0, 1.0);
  return (p - a - t * ab).norm() - (ra + t * (rb - ra));
}

/// Box about `centre` with half sizes `half`, edges rounded with `radius` (included in `half`).
inline double rounded_box(const Vector3d& p, const Vector3d& centre, const Vector3d& half, double radius) {
  const Vector3d q = (p - centre).cwiseAbs() - half + Vector3d::Constant(radius);
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0) - radius;
}

/// Union, rounded where the two surfaces are closer than `k`.
inline double blend(double a, double b, double k) {
  const double h = std::max(k - std::abs(a - b), 0.0);
  return std::min(a, b) - h * h / (4 * k);
}

/// Intersection, rounded over `k`.
inline double intersect(double a, double b, double k) {
  return -blend(-a, -b, k);
}

/// `a` without `b`, rounded over `k`.
inline double carve(double a, double b, double k) {
  return -blend(-a, b, k);
}

/// A node of a bar: a point and the radius there.
struct BarNode {
  Vector3d point;
  double radius;
};

/// Chain of capsules through `nodes`, measured after the point is scaled by `stretch` about the chain, so that a
/// stretch of (2, 1, 1) makes the section half as wide in x. Distances are scaled back by the largest stretch.
inline double bar(const Vector3d& p, std::span<const BarNode> nodes, const Vector3d& stretch) {
  double distance = 1e30;
  const Vector3d q = p.cwiseProduct(stretch);
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    distance =
        std::min(distance, capsule(q, nodes[i].point.cwiseProduct(stretch), nodes[i + 1].point.cwiseProduct(stretch),
                                   nodes[i].radius, nodes[i + 1].radius));
  }
  return distance / stretch.maxCoeff();
}

}  // namespace phiz::implicit
