// SPDX-License-Identifier: GPL-3.0-or-later
/// Nearest point, ray, inside and point location queries. The classes build a tree once; the free functions build one
/// for a single call. All queries are const, thread-safe and deterministic (ties go to the lower triangle).
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "phiz/geometry/mesh.h"

namespace phiz {

/// A point of a triangle surface.
struct SurfacePoint {
  int triangle = -1;
  Vector3d barycentric = Vector3d::Zero();
  Vector3d position = Vector3d::Zero();
  double squared_distance = 0;  ///< to the query point, square metres
};

struct RayHit {
  int triangle = -1;
  Vector3d barycentric = Vector3d::Zero();
  double t = 0;  ///< position = origin + t * direction
};

/// Queries on one surface. Throws phiz::Error(bad_input) when there is no triangle or the mesh is malformed.
class SurfaceQuery {
 public:
  explicit SurfaceQuery(const TriangleMesh& mesh);
  SurfaceQuery(const MatrixX3d& V, const MatrixX3i& F);
  ~SurfaceQuery();
  SurfaceQuery(SurfaceQuery&&) noexcept;
  SurfaceQuery& operator=(SurfaceQuery&&) noexcept;

  /// Moves the vertices and keeps the tree's shape: O(n), for deforming surfaces. Rows of V as in the constructor.
  void refit(const MatrixX3d& V);

  SurfacePoint closest_point(const Vector3d& p) const;
  /// The closest point within `max_distance`, if any: cheaper than closest_point when most queries are far away.
  std::optional<SurfacePoint> closest_point_within(const Vector3d& p, double max_distance) const;
  /// Nearest hit with t in [min_t, max_t]; both sides count.
  std::optional<RayHit> first_hit(const Vector3d& origin, const Vector3d& direction, double min_t = 0,
                                  double max_t = 1e30) const;
  /// Every hit with t in [min_t, max_t], sorted by t.
  std::vector<RayHit> all_hits(const Vector3d& origin, const Vector3d& direction, double min_t = 0,
                               double max_t = 1e30) const;
  /// Triangles whose bounding box overlaps the box [low, high], sorted.
  std::vector<int> triangles_in_box(const Vector3d& low, const Vector3d& high) const;

  /// Generalised winding number (Jacobson et al. 2013; far clusters as dipoles, Barill et al. 2018): 1 inside, 0
  /// outside of a closed outward surface, between the two near holes of an open one. Error below 0.03.
  double winding_number(const Vector3d& p) const;
  bool is_inside(const Vector3d& p) const { return winding_number(p) > 0.5; }
  /// Distance to the surface, negative inside.
  double signed_distance(const Vector3d& p) const;

  // In parallel over rows of P.
  std::vector<SurfacePoint> closest_points(const MatrixX3d& P) const;
  VectorXd signed_distances(const MatrixX3d& P) const;
  VectorXd winding_numbers(const MatrixX3d& P) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

std::vector<SurfacePoint> closest_points(const TriangleMesh& mesh, const MatrixX3d& P);
VectorXd signed_distances(const TriangleMesh& mesh, const MatrixX3d& P);

/// The closest point of one triangle (Ericson 2005, 5.1.5): barycentric coordinates, all in [0, 1].
Vector3d closest_barycentric(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c);

/// Where a point lies in a tet mesh.
struct TetPoint {
  int tet = -1;
  Eigen::Vector4d barycentric = Eigen::Vector4d::Zero();
};

/// Point location in a tet mesh. Throws phiz::Error(bad_input) when there is no tet.
class TetQuery {
 public:
  TetQuery(const MatrixX3d& V, const MatrixX4i& T);
  explicit TetQuery(const TetMesh& mesh) : TetQuery(mesh.V, mesh.T) {}
  ~TetQuery();
  TetQuery(TetQuery&&) noexcept;
  TetQuery& operator=(TetQuery&&) noexcept;

  /// The tet that holds p (the lowest one on a shared face), or nothing outside of the mesh.
  std::optional<TetPoint> locate(const Vector3d& p) const;
  /// The tet that holds p, else the nearest one; outside, barycentric holds the clamped coordinates of the nearest
  /// point of the mesh.
  TetPoint nearest(const Vector3d& p) const;

  // In parallel over rows of P; tet = -1 outside for `locate_all`.
  std::vector<TetPoint> locate_all(const MatrixX3d& P) const;
  std::vector<TetPoint> nearest_all(const MatrixX3d& P) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

/// Weights W (rows of P x rows of V) with P ~ W V, from TetPoints or SurfacePoints; a row for `-1` is zero.
SparseMatrixd interpolation_matrix(const std::vector<TetPoint>& points, const MatrixX4i& T, Eigen::Index vertex_count);
SparseMatrixd interpolation_matrix(const std::vector<SurfacePoint>& points, const MatrixX3i& F,
                                   Eigen::Index vertex_count);

}  // namespace phiz
