// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/geometry/surface.h"

#include <Eigen/Geometry>
#include <cmath>

#include "phiz/geometry/topology.h"

namespace phiz {

MatrixX3d triangle_area_normals(const MatrixX3d& V, const MatrixX3i& F) {
  MatrixX3d N(F.rows(), 3);
  for (Eigen::Index f = 0; f < F.rows(); ++f) {
    const Vector3d a = V.row(F(f, 0)), b = V.row(F(f, 1)), c = V.row(F(f, 2));
    N.row(f) = (b - a).cross(c - a);
  }
  return N;
}

MatrixX3d triangle_normals(const MatrixX3d& V, const MatrixX3i& F) {
  MatrixX3d N = triangle_area_normals(V, F);
  for (Eigen::Index f = 0; f < N.rows(); ++f) {
    const double length = N.row(f).norm();
    if (length > 0) N.row(f) /= length;
  }
  return N;
}

VectorXd triangle_areas(const MatrixX3d& V, const MatrixX3i& F) {
  return 0.5 * triangle_area_normals(V, F).rowwise().norm();
}

MatrixX3d vertex_normals(const MatrixX3d& V, const MatrixX3i& F) {
  const MatrixX3d face_normals = triangle_normals(V, F);
  MatrixX3d N = MatrixX3d::Zero(V.rows(), 3);
  for (Eigen::Index f = 0; f < F.rows(); ++f)
    for (int k = 0; k < 3; ++k) {
      const Vector3d e1 = V.row(F(f, (k + 1) % 3)) - V.row(F(f, k));
      const Vector3d e2 = V.row(F(f, (k + 2) % 3)) - V.row(F(f, k));
      N.row(F(f, k)) += std::atan2(e1.cross(e2).norm(), e1.dot(e2)) * face_normals.row(f);
    }
  for (Eigen::Index v = 0; v < N.rows(); ++v) {
    const double length = N.row(v).norm();
    if (length > 0) N.row(v) /= length;
  }
  return N;
}

double signed_volume(const MatrixX3d& V, const MatrixX3i& F) {
  if (F.rows() == 0) return 0;
  const Vector3d origin = V.row(F(0, 0));  // near the surface, to lose no digits
  double volume = 0;
  for (Eigen::Index f = 0; f < F.rows(); ++f) {
    const Vector3d a = V.row(F(f, 0)).transpose() - origin, b = V.row(F(f, 1)).transpose() - origin,
                   c = V.row(F(f, 2)).transpose() - origin;
    volume += a.dot(b.cross(c)) / 6;
  }
  return volume;
}

Vector3d volume_centroid(const MatrixX3d& V, const MatrixX3i& F) {
  if (F.rows() == 0) return Vector3d::Zero();
  const Vector3d origin = V.row(F(0, 0));
  Vector3d moment = Vector3d::Zero();
  double volume = 0;
  for (Eigen::Index f = 0; f < F.rows(); ++f) {
    const Vector3d a = V.row(F(f, 0)).transpose() - origin, b = V.row(F(f, 1)).transpose() - origin,
                   c = V.row(F(f, 2)).transpose() - origin;
    const double share = a.dot(b.cross(c)) / 6;
    volume += share;
    moment += share / 4 * (a + b + c);
  }
  return volume != 0 ? Vector3d(origin + moment / volume) : origin;
}

double mean_edge_length(const MatrixX3d& V, const MatrixX3i& F) {
  const MatrixX2i E = edges(F);
  if (E.rows() == 0) return 0;
  double sum = 0;
  for (Eigen::Index e = 0; e < E.rows(); ++e) sum += (V.row(E(e, 0)) - V.row(E(e, 1))).norm();
  return sum / static_cast<double>(E.rows());
}

TriangleMesh joined(std::span<const TriangleMesh> meshes) {
  TriangleMesh all;
  Eigen::Index v = 0, f = 0, uv = 0;
  for (const TriangleMesh& m : meshes) v += m.V.rows(), f += m.F.rows(), uv += m.UV.rows();
  all.V.resize(v, 3);
  all.F.resize(f, 3);
  all.UV.resize(uv, 2);
  all.FUV.resize(uv > 0 ? f : 0, 3);
  v = f = uv = 0;
  for (const TriangleMesh& m : meshes) {
    all.V.middleRows(v, m.V.rows()) = m.V;
    all.F.middleRows(f, m.F.rows()) = m.F.array() + static_cast<int>(v);
    if (all.UV.rows() > 0) {
      all.UV.middleRows(uv, m.UV.rows()) = m.UV;
      all.FUV.middleRows(f, m.FUV.rows()) = m.FUV.array() + static_cast<int>(uv);
    }
    v += m.V.rows(), f += m.F.rows(), uv += m.UV.rows();
  }
  return all;
}

TriangleMesh thickened(const TriangleMesh& sheet, double thickness) {
  const auto n = static_cast<int>(sheet.V.rows());
  const Eigen::Index faces = sheet.F.rows();
  const auto loops = boundary_loops(sheet.F);
  Eigen::Index rim = 0;
  for (const auto& loop : loops) rim += static_cast<Eigen::Index>(loop.size());
  TriangleMesh shell;
  shell.V.resize(2 * n, 3);
  shell.V << sheet.V, sheet.V - thickness * vertex_normals(sheet.V, sheet.F);
  shell.F.resize(2 * faces + 2 * rim, 3);
  shell.F.topRows(faces) = sheet.F;
  shell.F.middleRows(faces, faces) = sheet.F.rowwise().reverse().array() + n;
  Eigen::Index f = 2 * faces;
  for (const auto& loop : loops)
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const int a = loop[i], b = loop[(i + 1) % loop.size()];
      shell.F.row(f++) << b, a, a + n;
      shell.F.row(f++) << b, a + n, b + n;
    }
  return shell;
}

MatrixX3d rows_of(const std::vector<Vector3d>& points) {
  MatrixX3d rows(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) rows.row(static_cast<Eigen::Index>(i)) = points[i];
  return rows;
}

std::vector<int> farthest_points(const MatrixX3d& points, Eigen::Index count) {
  std::vector<int> chosen{0};
  VectorXd distance = (points.rowwise() - points.row(0)).rowwise().squaredNorm();
  while (static_cast<Eigen::Index>(chosen.size()) < count) {
    Eigen::Index farthest = 0;
    if (distance.maxCoeff(&farthest) <= 0) break;
    chosen.push_back(static_cast<int>(farthest));
    distance = distance.cwiseMin((points.rowwise() - points.row(farthest)).rowwise().squaredNorm());
  }
  return chosen;
}

}  // namespace phiz
