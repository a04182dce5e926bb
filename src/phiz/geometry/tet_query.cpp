// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>

#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/geometry/box_tree.h"
#include "phiz/geometry/operators.h"
#include "phiz/geometry/spatial_query.h"
#include "phiz/geometry/topology.h"
#include "phiz/geometry/validate.h"

namespace phiz {

namespace {

std::vector<AlignedBox> tet_boxes(const MatrixX3d& V, const MatrixX4i& T) {
  std::vector<AlignedBox> boxes(static_cast<std::size_t>(T.rows()));
  for (Eigen::Index t = 0; t < T.rows(); ++t)
    for (int k = 0; k < 4; ++k) boxes[static_cast<std::size_t>(t)].extend(Vector3d(V.row(T(t, k))));
  return boxes;
}

constexpr double on_face = -1e-12;  // barycentric coordinate that still counts as inside

}  // namespace

struct TetQuery::Tree {
  MatrixX3d V;
  MatrixX4i T;
  BoxTree tree;
  MatrixX3i outside;             // boundary triangles
  std::vector<int> outside_tet;  // tet per boundary triangle
  SurfaceQuery surface;

  Tree(const MatrixX3d& vertices, const MatrixX4i& tets)
      : V(vertices), T(tets), tree(tet_boxes(V, T)), outside(boundary_triangles(T)), surface(V, outside) {
    const MatrixX4i neighbours = tet_neighbours(T);
    for (int t = 0; t < T.rows(); ++t)
      for (int k = 0; k < 4; ++k)
        if (neighbours(t, k) < 0) outside_tet.push_back(t);
  }

  Eigen::Vector4d weights(int t, const Vector3d& p) const {
    return barycentric(p, V.row(T(t, 0)), V.row(T(t, 1)), V.row(T(t, 2)), V.row(T(t, 3)));
  }
};

TetQuery::TetQuery(const MatrixX3d& V, const MatrixX4i& T) {
  if (T.rows() == 0) reject("tet query", "the mesh has no tets");
  if (T.minCoeff() < 0 || T.maxCoeff() >= V.rows() || !V.allFinite())
    validate(TetMesh{V, T, VectorXi::Zero(T.rows())}, "tet query");
  tree_ = std::make_unique<Tree>(V, T);
}

TetQuery::~TetQuery() = default;
TetQuery::TetQuery(TetQuery&&) noexcept = default;
TetQuery& TetQuery::operator=(TetQuery&&) noexcept = default;

std::optional<TetPoint> TetQuery::locate(const Vector3d& p) const {
  TetPoint found;
  tree_->tree.each_overlapping(
      [&p](const AlignedBox& box) { return box.squaredExteriorDistance(p) <= 1e-24 * box.sizes().squaredNorm(); },
      [&](int t) {
        if (found.tet >= 0 && t > found.tet) return;
        const Eigen::Vector4d weights = tree_->weights(t, p);
        if (weights.minCoeff() >= on_face) found = {t, weights};
      });
  if (found.tet < 0) return std::nullopt;
  return found;
}

TetPoint TetQuery::nearest(const Vector3d& p) const {
  if (const auto inside = locate(p)) return *inside;
  const SurfacePoint surface_point = tree_->surface.closest_point(p);
  TetPoint result;
  result.tet = tree_->outside_tet[static_cast<std::size_t>(surface_point.triangle)];
  for (int k = 0; k < 3; ++k)
    for (int corner = 0; corner < 4; ++corner)
      if (tree_->T(result.tet, corner) == tree_->outside(surface_point.triangle, k))
        result.barycentric[corner] = surface_point.barycentric[k];
  return result;
}

std::vector<TetPoint> TetQuery::locate_all(const MatrixX3d& P) const {
  std::vector<TetPoint> result(static_cast<std::size_t>(P.rows()));
  parallel_for(P.rows(), [&](Eigen::Index i) {
    if (const auto found = locate(P.row(i))) result[static_cast<std::size_t>(i)] = *found;
  });
  return result;
}

std::vector<TetPoint> TetQuery::nearest_all(const MatrixX3d& P) const {
  std::vector<TetPoint> result(static_cast<std::size_t>(P.rows()));
  parallel_for(P.rows(), [&](Eigen::Index i) { result[static_cast<std::size_t>(i)] = nearest(P.row(i)); });
  return result;
}

SparseMatrixd interpolation_matrix(const std::vector<TetPoint>& points, const MatrixX4i& T, Eigen::Index vertex_count) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (int k = 0; points[i].tet >= 0 && k < 4; ++k)
      entries.emplace_back(static_cast<int>(i), T(points[i].tet, k), points[i].barycentric[k]);
  SparseMatrixd W(static_cast<Eigen::Index>(points.size()), vertex_count);
  W.setFromTriplets(entries.begin(), entries.end());
  return W;
}

}  // namespace phiz
