// SPDX-License-Identifier: GPL-3.0-or-later
/// Small meshes for tests.
#pragma once

#include <cmath>
#include <map>

#include "phiz/geometry/mesh.h"

namespace phiz::test {

/// Outward axis-aligned box with 12 triangles.
inline TriangleMesh box(const Vector3d& low, const Vector3d& high) {
  TriangleMesh mesh;
  mesh.V.resize(8, 3);
  for (int i = 0; i < 8; ++i)
    for (int k = 0; k < 3; ++k) mesh.V(i, k) = ((i >> k) & 1) != 0 ? high[k] : low[k];
  mesh.F.resize(12, 3);
  mesh.F << 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5;
  return mesh;
}

/// Outward sphere: a subdivided octahedron with 8 * 4^levels triangles.
inline TriangleMesh sphere(const Vector3d& centre, double radius, int levels) {
  std::vector<Vector3d> points{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  std::vector<Eigen::Vector3i> faces{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                     {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<int, int>, int> middle;
    const auto mid = [&](int a, int b) {
      const auto [it, added] = middle.emplace(std::minmax(a, b), static_cast<int>(points.size()));
      if (added)
        points.push_back((points[static_cast<std::size_t>(a)] + points[static_cast<std::size_t>(b)]).normalized());
      return it->second;
    };
    std::vector<Eigen::Vector3i> finer;
    for (const auto& f : faces) {
      const int a = mid(f[0], f[1]), b = mid(f[1], f[2]), c = mid(f[2], f[0]);
      finer.insert(finer.end(), {{f[0], a, c}, {a, f[1], b}, {c, b, f[2]}, {a, b, c}});
    }
    faces = std::move(finer);
  }
  TriangleMesh mesh;
  mesh.V.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i)
    mesh.V.row(static_cast<Eigen::Index>(i)) = centre + radius * points[i];
  mesh.F.resize(static_cast<Eigen::Index>(faces.size()), 3);
  for (std::size_t i = 0; i < faces.size(); ++i) mesh.F.row(static_cast<Eigen::Index>(i)) = faces[i];
  return mesh;
}

/// A torus round the y axis, outward.
inline TriangleMesh torus(double major, double minor, int around, int across) {
  TriangleMesh mesh;
  mesh.V.resize(around * across, 3);
  mesh.F.resize(2 * around * across, 3);
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double u = 2 * M_PI * i / around, v = 2 * M_PI * j / across;
      const double r = major + minor * std::cos(v);
      mesh.V.row(i * across + j) << r * std::cos(u), minor * std::sin(v), r * std::sin(u);
      const int a = i * across + j, b = ((i + 1) % around) * across + j,
                c = ((i + 1) % around) * across + (j + 1) % across, d = i * across + (j + 1) % across;
      mesh.F.row(2 * (i * across + j)) << a, c, b;
      mesh.F.row(2 * (i * across + j) + 1) << a, d, c;
    }
  return mesh;
}

/// A Moebius strip of `count` quads: one boundary loop, not orientable.
inline TriangleMesh moebius(int count) {
  TriangleMesh mesh;
  mesh.V.resize(2 * count, 3);
  mesh.F.resize(2 * count, 3);
  for (int i = 0; i < count; ++i) {
    const double u = 2 * M_PI * i / count;
    for (int side = 0; side < 2; ++side) {
      const double w = side == 0 ? -0.3 : 0.3, r = 1 + w * std::cos(u / 2);
      mesh.V.row(2 * i + side) << r * std::cos(u), r * std::sin(u), w * std::sin(u / 2);
    }
    const int a = 2 * i, b = 2 * i + 1;
    const int c = i + 1 < count ? 2 * i + 2 : 1, d = i + 1 < count ? 2 * i + 3 : 0;
    mesh.F.row(2 * i) << a, c, b;
    mesh.F.row(2 * i + 1) << b, c, d;
  }
  return mesh;
}

}  // namespace phiz::test
