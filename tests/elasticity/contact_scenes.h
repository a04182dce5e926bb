// SPDX-License-Identifier: GPL-3.0-or-later
/// Bodies in contact for the tests of both engines.
#pragma once

#include <algorithm>
#include <vector>

#include "elasticity/tissue_blocks.h"
#include "phiz/elasticity/contact.h"
#include "phiz/geometry/topology.h"

namespace phiz::testing {

/// The rest state made a little flatter, so that what touches there is not taken to be inside.
inline MatrixX3d flatter(const TissueBody& body) {
  MatrixX3d x = body.rest;
  x.col(1) = (x.col(1).array() - 0.5 * breadth) * 0.99 + 0.5 * breadth;
  return x;
}

/// A floor whose upper side is y = 0, below a block.
struct Floor {
  TissueBody body = block();
  ContactScene contacts{body.rest.rows()};

  explicit Floor(const Vector3d& gravity) {
    weigh(body, gravity);
    const int floor = contacts.add_rigid(rigid_box({-0.1, -0.05, -0.1}, {0.2, 0, 0.2}));
    contacts.add_pair(vertices_where(body, [](const Vector3d& p) { return p.y() == 0; }), floor, -1, flatter(body));
  }
};

/// Two soft blocks of one body, one above the other, held at the far sides.
struct Lips {
  static constexpr double gap = 5e-4;
  TissueBody body;
  MatrixX3i lower_patch, upper_patch;
  VectorXi lower_vertices, upper_vertices;
  Eigen::Index split = 0;

  Lips() {
    const TetMesh lower = box({-0.02, -0.008, 0}, {0.02, 0, 0.01}, 8, 3, 3);
    const TetMesh upper = box({-0.023, gap, 0.001}, {0.023, 0.008 + gap, 0.011}, 9, 3, 3);
    split = lower.V.rows();
    TetMesh both;
    both.V.resize(split + upper.V.rows(), 3);
    both.V << lower.V, upper.V;
    both.T.resize(lower.T.rows() + upper.T.rows(), 4);
    both.T << lower.T, (upper.T.array() + static_cast<int>(split)).matrix();
    body = tissue_of(both);
    pin(body, [](const Vector3d& p) { return p.y() < -0.0079 || p.y() > 0.0079 + gap; });
    take(boundary_triangles(both.T), true, upper_patch, upper_vertices);
    take(boundary_triangles(both.T), false, lower_patch, lower_vertices);
  }

  /// All of a block's outside but for its held side.
  void take(const MatrixX3i& F, bool of_upper, MatrixX3i& patch, VectorXi& vertices) const {
    std::vector<int> rows;
    for (Eigen::Index f = 0; f < F.rows(); ++f)
      if ((F(f, 0) >= split) == of_upper && (body.rest(F.row(f), 1).array() - 0.5 * gap).abs().minCoeff() < 0.0075)
        rows.push_back(static_cast<int>(f));
    patch = F(rows, Eigen::all);
    std::vector<int> used(patch.data(), patch.data() + patch.size());
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    vertices = Eigen::Map<VectorXi>(used.data(), static_cast<Eigen::Index>(used.size()));
  }

  ContactScene scene() const {
    ContactScene contacts(body.rest.rows());
    const int lower = contacts.add_patch(body.rest, lower_patch), upper = contacts.add_patch(body.rest, upper_patch);
    contacts.add_pair(upper_vertices, lower, upper, body.rest);
    contacts.add_pair(lower_vertices, upper, lower, body.rest);
    return contacts;
  }

  MatrixX3d pressed(MatrixX3d x, double down, double aside) const {
    for (Eigen::Index v = split; v < x.rows(); ++v)
      if (body.pinned[static_cast<std::size_t>(v)] != 0)
        x.row(v) = body.rest.row(v) + Eigen::RowVector3d(aside, -down, 0);
    return x;
  }
};

}  // namespace phiz::testing
