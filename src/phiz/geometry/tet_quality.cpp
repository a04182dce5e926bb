// SPDX-License-Identifier: GPL-3.0-or-later
#include <spdlog/fmt/fmt.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "phiz/geometry/operators.h"
#include "phiz/geometry/tetrahedralise.h"
#include "phiz/geometry/topology.h"

namespace phiz {

double radius_ratio(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  const Vector3d u = b - a, v = c - a, w = d - a;
  const double six_volume = u.cross(v).dot(w);
  const double areas = u.cross(v).norm() + v.cross(w).norm() + w.cross(u).norm() + (v - u).cross(w - u).norm();
  const double reach =
      (u.squaredNorm() * v.cross(w) + v.squaredNorm() * w.cross(u) + w.squaredNorm() * u.cross(v)).norm();
  // inradius = six_volume / areas, circumradius = reach / (2 six_volume)
  const double below = areas * reach;
  return below > 0 ? 6 * six_volume * std::abs(six_volume) / below : 0;
}

std::array<double, 2> dihedral_range(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  const Vector3d* p[4] = {&a, &b, &c, &d};
  double low = 180, high = 0;
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j) {
      int rest[2], count = 0;
      for (int k = 0; k < 4; ++k)
        if (k != i && k != j) rest[count++] = k;
      const Vector3d edge = *p[j] - *p[i];
      const Vector3d n1 = edge.cross(*p[rest[0]] - *p[i]), n2 = edge.cross(*p[rest[1]] - *p[i]);
      const double angle = std::atan2(n1.cross(n2).norm(), n1.dot(n2)) * 180 / std::numbers::pi;
      low = std::min(low, angle);
      high = std::max(high, angle);
    }
  return {low, high};
}

TetQuality tet_quality(const TetMesh& mesh) {
  TetQuality q;
  q.tets = mesh.T.rows();
  q.vertices = mesh.V.rows();
  if (q.tets == 0) return q;
  q.min_dihedral = 180;
  q.min_radius_ratio = std::numeric_limits<double>::infinity();
  for (Eigen::Index t = 0; t < q.tets; ++t) {
    const Vector3d a = mesh.V.row(mesh.T(t, 0)), b = mesh.V.row(mesh.T(t, 1)), c = mesh.V.row(mesh.T(t, 2)),
                   d = mesh.V.row(mesh.T(t, 3));
    const double ratio = radius_ratio(a, b, c, d);
    const auto [low, high] = dihedral_range(a, b, c, d);
    q.min_dihedral = std::min(q.min_dihedral, low);
    q.max_dihedral = std::max(q.max_dihedral, high);
    q.mean_radius_ratio += ratio / static_cast<double>(q.tets);
    if (ratio < q.min_radius_ratio) {
      q.min_radius_ratio = ratio;
      q.worst_tet = static_cast<int>(t);
    }
    ++q.radius_ratio_histogram[static_cast<std::size_t>(std::clamp(static_cast<int>(ratio * 10), 0, 9))];
  }
  const VectorXd volumes = tet_volumes(mesh.V, mesh.T);
  q.min_volume = volumes.minCoeff();
  q.total_volume = volumes.sum();
  const MatrixX2i E = tet_edges(mesh.T);
  q.min_edge = std::numeric_limits<double>::infinity();
  for (Eigen::Index e = 0; e < E.rows(); ++e) {
    const double length = (mesh.V.row(E(e, 0)) - mesh.V.row(E(e, 1))).norm();
    q.min_edge = std::min(q.min_edge, length);
    q.max_edge = std::max(q.max_edge, length);
    q.mean_edge += length / static_cast<double>(E.rows());
  }
  return q;
}

std::string brief_report(const TetQuality& q) {
  return fmt::format(
      "{} tets, {} vertices, dihedral {:.1f} to {:.1f} degrees, radius ratio min {:.3f} mean {:.3f}, edge {:.2f} to "
      "{:.2f} mm "
      "(mean {:.2f})",
      q.tets, q.vertices, q.min_dihedral, q.max_dihedral, q.min_radius_ratio, q.mean_radius_ratio, q.min_edge * 1e3,
      q.max_edge * 1e3, q.mean_edge * 1e3);
}

}  // namespace phiz
