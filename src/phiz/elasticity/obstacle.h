// SPDX-License-Identifier: GPL-3.0-or-later
/// An obstacle of contact detection: a triangle surface with the signed distance to its outward side.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "phiz/elasticity/contact.h"
#include "phiz/geometry/spatial_query.h"

namespace phiz {

/// The closest point of an obstacle and the sign of the distance to it.
struct SignedContact {
  double gap = 0;  ///< metres, negative inside
  Vector3d normal = Vector3d::UnitZ();
  int triangle = -1;
  Vector3d barycentric = Vector3d::Zero();
  bool on_rim = false;  ///< the closest point lies on the boundary of an open patch: there is no inside or outside
};

class Obstacle {
 public:
  /// A patch: `triangles` over rows of `rest`.
  static Obstacle patch(const MatrixX3d& rest, const MatrixX3i& triangles);
  static Obstacle rigid(const TriangleMesh& mesh);

  bool is_rigid() const { return vertices_.empty(); }
  /// Body vertex of each of the obstacle's own vertices; empty for a rigid one.
  const std::vector<int>& vertices() const { return vertices_; }
  const MatrixX3i& triangles() const { return F_; }

  void place(const Eigen::Isometry3d& transform);
  /// Takes the positions of a patch; the queries below want refit() after it.
  void follow(const PositionView& positions);
  void refit();

  /// The closest point within `reach`. The sign comes from the pseudo-normal of the closest face, edge or vertex
  /// (Baerentzen and Aanaes 2005).
  /// `hint`: a triangle that is likely to be near, or -1; it only makes the search faster.
  std::optional<SignedContact> closest(const Vector3d& point, double reach, int hint = -1) const;

  /// Faces beside the closest one that stand up from its plane within `reach` of the point: in the hollow between two
  /// faces a vertex must stay outside of both. At most two, nearest first; the gap is that to the face's plane.
  std::vector<SignedContact> beside(const Vector3d& point, const SignedContact& closest, double reach) const;

  /// Where the point of a contact is now, by its triangle and barycentric coordinates.
  Vector3d point(const SignedContact& contact) const;

  /// Pairs of own vertices: edges of the rim whose ends are vertices of `other` too.
  std::vector<int> shared_edges(const Obstacle& other) const;
  /// Length of the way from a point by `edges` (pairs of own vertices) to the closest point of the obstacle, metres, a
  /// little more than the shortest.
  double way_over(const std::vector<int>& edges, const Vector3d& point, const SignedContact& closest) const;

  bool has_vertex(int vertex) const;
  /// Outward normal at body vertex `vertex`, zero if it is not one of the obstacle's.
  Vector3d normal_at(int vertex) const;

  /// Sum over all moves of the longest way that a vertex went, metres.
  double travel() const { return travel_; }

 private:
  Obstacle(const MatrixX3d& V, const MatrixX3i& F, std::vector<int> vertices);
  Vector3d face_normal(int face) const;
  Vector3d vertex_normal(int vertex) const;

  MatrixX3d V_;
  MatrixX3i F_;
  MatrixX3i neighbours_;
  std::vector<char> on_rim_;
  std::vector<int> vertices_;
  std::vector<std::pair<int, int>> local_;  ///< (body vertex, own vertex), sorted
  SurfaceQuery query_;
  std::vector<int> ring_start_, ring_;  ///< triangles round each vertex
  Eigen::Isometry3d transform_ = Eigen::Isometry3d::Identity();
  Vector3d low_, high_;
  double travel_ = 0;
  bool refitted_ = true;
};

}  // namespace phiz
