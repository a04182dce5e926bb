// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces that the renderer's tests look at.
#pragma once

#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "phiz/render/scene.h"

namespace phiz::test {

/// Sphere from a subdivided octahedron; `levels` of subdivision.
inline TriangleMesh sphere(double radius, int levels) {
  std::vector<Vector3d> v = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  std::vector<Eigen::Vector3i> f = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                    {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<int, int>, int> middle;
    const auto mid = [&](int a, int b) {
      const auto [place, fresh] = middle.try_emplace(std::minmax(a, b), static_cast<int>(v.size()));
      if (fresh) v.push_back((v[a] + v[b]).normalized());
      return place->second;
    };
    std::vector<Eigen::Vector3i> finer;
    for (const Eigen::Vector3i& t : f) {
      const int a = mid(t[0], t[1]), b = mid(t[1], t[2]), c = mid(t[2], t[0]);
      finer.insert(finer.end(), {{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {a, b, c}});
    }
    f = finer;
  }
  TriangleMesh mesh;
  mesh.V.resize(static_cast<Eigen::Index>(v.size()), 3);
  for (std::size_t i = 0; i < v.size(); ++i) mesh.V.row(static_cast<Eigen::Index>(i)) = radius * v[i].transpose();
  mesh.F.resize(static_cast<Eigen::Index>(f.size()), 3);
  for (std::size_t i = 0; i < f.size(); ++i) mesh.F.row(static_cast<Eigen::Index>(i)) = f[i].transpose();
  return mesh;
}

/// Axis-aligned box of eight vertices, outward triangles.
inline TriangleMesh box(const Vector3d& low, const Vector3d& high) {
  TriangleMesh mesh;
  mesh.V.resize(8, 3);
  for (int i = 0; i < 8; ++i)
    mesh.V.row(i) << ((i & 1) != 0 ? high : low).x(), ((i & 2) != 0 ? high : low).y(), ((i & 4) != 0 ? high : low).z();
  mesh.F.resize(12, 3);
  mesh.F << 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5;
  return mesh;
}

inline Surface surface_of(TriangleMesh mesh) {
  Surface s;
  s.name = "test";
  s.mesh = std::move(mesh);
  return s;
}

/// Null where the scene has no surface of that name.
inline const Surface* find(const Scene& scene, const std::string& name) {
  for (const Surface& s : scene.surfaces)
    if (s.name == name) return &s;
  return nullptr;
}

}  // namespace phiz::test
