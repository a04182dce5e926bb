// SPDX-License-Identifier: GPL-3.0-or-later
/// Small meshes that the tests of the readers and writers use.
#pragma once

#include "phiz/geometry/mesh.h"

namespace phiz {

/// A cube of 0.2 m with quads, texture coordinates and two groups.
inline PolygonMesh sample_cube() {
  PolygonMesh cube;
  cube.V.resize(8, 3);
  for (int i = 0; i < 8; ++i) cube.V.row(i) << 0.2 * (i & 1), 0.2 * ((i >> 1) & 1), 0.2 * (i >> 2);
  cube.faces = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  cube.UV.resize(4, 2);
  cube.UV << 0, 0, 1, 0, 1, 1, 0, 1;
  cube.face_uvs.assign(6, {0, 1, 2, 3});
  cube.groups = {"sides", "caps"};
  cube.face_group = {1, 1, 0, 0, 0, 0};
  return cube;
}

/// A tetrahedron of 0.1 m.
inline TriangleMesh sample_tetrahedron() {
  TriangleMesh mesh;
  mesh.V.resize(4, 3);
  mesh.V << 0, 0, 0, 0.1, 0, 0, 0, 0.1, 0, 0, 0, 0.1;
  mesh.F.resize(4, 3);
  mesh.F << 0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3;
  return mesh;
}

}  // namespace phiz
