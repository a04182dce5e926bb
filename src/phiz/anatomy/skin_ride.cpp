// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/skin_ride.h"

#include <Eigen/Dense>
#include <algorithm>

#include "phiz/core/parallel.h"
#include "phiz/geometry/spatial_query.h"
#include "phiz/geometry/topology.h"

namespace phiz {

SkinRide::SkinRide(const TriangleMesh& skin, const TriangleMesh& part) : skin_(skin.V), part_(part.V) {
  if (part.F.rows() == 0) return;
  const VectorXi component = triangle_components(part.F);
  pieces_.resize(static_cast<std::size_t>(component.maxCoeff()) + 1);
  for (Eigen::Index f = 0; f < part.F.rows(); ++f)
    for (int k = 0; k < 3; ++k) pieces_[static_cast<std::size_t>(component[f])].rows.push_back(part.F(f, k));

  const SurfaceQuery query(skin);
  const std::vector<SurfacePoint> nearest = query.closest_points(part.V);
  const std::vector<std::vector<int>> neighbours = vertex_neighbours(skin.F, static_cast<int>(skin.V.rows()));
  for (Piece& piece : pieces_) {
    std::sort(piece.rows.begin(), piece.rows.end());
    piece.rows.erase(std::unique(piece.rows.begin(), piece.rows.end()), piece.rows.end());
    const int root = *std::min_element(piece.rows.begin(), piece.rows.end(), [&](int a, int b) {
      return nearest[static_cast<std::size_t>(a)].squared_distance <
             nearest[static_cast<std::size_t>(b)].squared_distance;
    });
    const SurfacePoint& place = nearest[static_cast<std::size_t>(root)];
    piece.triangle = skin.F.row(place.triangle);
    piece.barycentric = place.barycentric;
    for (const int v : piece.triangle) {
      const auto& ring = neighbours[static_cast<std::size_t>(v)];
      piece.patch.insert(piece.patch.end(), ring.begin(), ring.end());
    }
    std::sort(piece.patch.begin(), piece.patch.end());
    piece.patch.erase(std::unique(piece.patch.begin(), piece.patch.end()), piece.patch.end());
  }
}

MatrixX3d SkinRide::operator()(const MatrixX3d& skin_now) const {
  MatrixX3d moved = part_;
  parallel_for(static_cast<std::ptrdiff_t>(pieces_.size()), [&](std::ptrdiff_t i) {
    const Piece& piece = pieces_[static_cast<std::size_t>(i)];
    const auto root = [&](const MatrixX3d& V) -> Vector3d {
      return (piece.barycentric.transpose() * V(piece.triangle, Eigen::all)).transpose();
    };
    const Matrix3d turn =
        Eigen::umeyama(skin_(piece.patch, Eigen::all).transpose(), skin_now(piece.patch, Eigen::all).transpose(), false)
            .topLeftCorner<3, 3>();
    const Vector3d from = root(skin_), to = root(skin_now);
    for (const int v : piece.rows) moved.row(v) = to + turn * (part_.row(v).transpose() - from);
  });
  return moved;
}

}  // namespace phiz
