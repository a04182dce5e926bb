// SPDX-License-Identifier: GPL-3.0-or-later
/// Contact detection between named pairs of regions (Ichim 2017, section 5.3.5): vertices of a deformable body against
/// the tangent planes of obstacles, which are patches of the same body or rigid surfaces.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "phiz/geometry/mesh.h"

namespace phiz {

struct ContactOptions {
  double margin = 6e-4;       ///< rows are made for gaps below this, metres: what a vertex may cover in one iteration
  double depth_limit = 6e-3;  ///< a vertex deeper than this is taken to be on the other side of the obstacle, metres
  /// A contact keeps its plane until vertex and obstacle together may have moved this far, metres: near a solution
  /// planes change by less than that, and the set of contacts must not change without end.
  double lag = 4e-5;
};

/// Where the vertices of a body are: row `row[v]` (or v if null) of an array with `stride` doubles per row.
struct PositionView {
  const double* x = nullptr;
  int stride = 3;
  const int* row = nullptr;

  Vector3d operator[](int vertex) const {
    const double* p = x + static_cast<std::ptrdiff_t>(stride) * (row != nullptr ? row[vertex] : vertex);
    return {p[0], p[1], p[2]};
  }
};

/// One unilateral row: gap + normal . sum_k coefficient_k (movement of vertex_k) >= 0.
struct ContactRow {
  int vertices[4] = {-1, -1, -1, -1};  ///< rows of the body's vertices; the first one is the vertex in contact
  double coefficients[4] = {1, 0, 0, 0};
  int count = 1;
  Vector3d normal = Vector3d::UnitZ();  ///< outward normal of the obstacle
  double gap = 0;                       ///< signed distance, metres, negative when penetrating
  int pair = -1;
  int face = -1;  ///< triangle of the obstacle
};

class ContactScene {
 public:
  /// A body of `vertex_count` vertices.
  explicit ContactScene(Eigen::Index vertex_count, const ContactOptions& options = {});
  ~ContactScene();
  ContactScene(ContactScene&&) noexcept;
  ContactScene& operator=(ContactScene&&) noexcept;

  /// An obstacle that is a patch of the body: outward triangles over its vertices. Beside its rim there is no contact.
  /// Returns its number.
  int add_patch(const MatrixX3d& rest, const MatrixX3i& triangles);
  /// A rigid obstacle with outward triangles. Returns its number.
  int add_rigid(const TriangleMesh& mesh);
  /// Vertices that must stay outside of an obstacle. `own_patch`: number of the patch that they belong to, or -1. A
  /// vertex that is inside of the obstacle in the state `rest` is left out of the pair: it is meant to be there.
  void add_pair(const VectorXi& vertices, int obstacle, int own_patch, const MatrixX3d& rest);

  /// Places a rigid obstacle: body frame from the obstacle's own.
  void place(int obstacle, const Eigen::Isometry3d& transform);

  /// Vertices that may take part in a row.
  VectorXi candidates() const;

  /// Rows of all pairs whose gap is below the margin, in a fixed order; more than one for a vertex in a hollow. Skips
  /// vertices that cannot have come near since the last call. Planes may be as old as the lag allows; gaps are those of
  /// the present state. `patience` stretches the lag.
  std::vector<ContactRow> detect(const PositionView& positions, double patience = 1);
  /// The next detect() depends on its state only.
  void forget();

  /// Deepest penetration over all pairs, metres, >= 0, of every vertex that can have come near: a
  /// second look at the state, apart from the rows that the solver used.
  double penetration(const PositionView& positions) const;
  double penetration(const MatrixX3d& x) const;

  const ContactOptions& options() const;
  /// Vertices left out because they are inside of their obstacle in the rest state.
  int left_out() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace phiz
