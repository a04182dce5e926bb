// SPDX-License-Identifier: GPL-3.0-or-later
/// Parts that grow on the skin (Carrier::flesh, such as lashes) and move with it.
#pragma once

#include <vector>

#include "phiz/anatomy/head_template.h"

namespace phiz {

/// How the connected pieces of a part ride the skin: each as a rigid body, by the patch of skin about its root, which
/// is where it comes nearest to the skin at rest.
class SkinRide {
 public:
  /// Throws phiz::Error(bad_input) when the skin has no triangles.
  SkinRide(const TriangleMesh& skin, const TriangleMesh& part);

  /// Vertices of the part when the skin's are at `skin_now` (as many as at rest).
  MatrixX3d operator()(const MatrixX3d& skin_now) const;

 private:
  struct Piece {
    std::vector<int> rows;  // of the part
    Eigen::Vector3i triangle;
    Vector3d barycentric;
    std::vector<int> patch;  // rows of the skin: the triangle's corners and their neighbours
  };

  MatrixX3d skin_, part_;  // at rest
  std::vector<Piece> pieces_;
};

}  // namespace phiz
