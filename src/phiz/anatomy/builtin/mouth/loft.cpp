// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/mouth/loft.h"

#include "phiz/core/error.h"
#include "phiz/geometry/surface.h"

namespace phiz {

MatrixX3d loft_vertices(std::span<const MatrixX3d> rings) {
  if (rings.size() < 2 || rings[0].rows() < 3) reject("loft", "needs two rings of three points");
  const Eigen::Index n = rings[0].rows(), count = static_cast<Eigen::Index>(rings.size());
  MatrixX3d V(n * count + 2, 3);
  for (Eigen::Index r = 0; r < count; ++r) V.middleRows(r * n, n) = rings[r];
  V.row(n * count) = rings.front().colwise().mean();
  V.row(n * count + 1) = rings.back().colwise().mean();
  return V;
}

TriangleMesh loft(std::span<const MatrixX3d> rings) {
  TriangleMesh mesh;
  mesh.V = loft_vertices(rings);
  const int n = static_cast<int>(rings[0].rows()), count = static_cast<int>(rings.size());
  const int last = n * (count - 1), first_middle = n * count;
  mesh.F.resize(2 * n * count, 3);
  mesh.FUV.resize(mesh.F.rows(), 3);
  // Texture coordinates on their own (n + 1) x (count + 2) grid: ends included, seam doubled.
  mesh.UV.resize((n + 1) * (count + 2), 2);
  for (int r = 0; r < count + 2; ++r) {
    for (int i = 0; i <= n; ++i) mesh.UV.row(r * (n + 1) + i) << i / double(n), r / double(count + 1);
  }
  Eigen::Index f = 0;
  const auto add = [&](int a, int b, int c, int ua, int ub, int uc) {
    mesh.F.row(f) << a, b, c;
    mesh.FUV.row(f++) << ua, ub, uc;
  };
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    const auto uv = [n](int r, int column) { return r * (n + 1) + column; };
    add(first_middle, i, j, uv(0, i), uv(1, i), uv(1, i + 1));
    for (int r = 0; r + 1 < count; ++r) {
      const int a = r * n + i, b = r * n + j, c = a + n, d = b + n;
      add(a, c, b, uv(r + 1, i), uv(r + 2, i), uv(r + 1, i + 1));
      add(b, c, d, uv(r + 1, i + 1), uv(r + 2, i), uv(r + 2, i + 1));
    }
    add(first_middle + 1, last + j, last + i, uv(count + 1, i), uv(count, i + 1), uv(count, i));
  }
  if (signed_volume(mesh.V, mesh.F) < 0) {
    mesh.F.col(1).swap(mesh.F.col(2));
    mesh.FUV.col(1).swap(mesh.FUV.col(2));
  }
  return mesh;
}

TriangleMesh mirrored(const TriangleMesh& mesh) {
  TriangleMesh image = mesh;
  image.V.col(0) *= -1;
  image.F.col(1).swap(image.F.col(2));
  if (image.FUV.rows() > 0) image.FUV.col(1).swap(image.FUV.col(2));
  return image;
}

}  // namespace phiz
