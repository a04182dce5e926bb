// SPDX-License-Identifier: GPL-3.0-or-later
/// New triangulations of given shapes.
#pragma once

#include <functional>

#include "phiz/geometry/mesh.h"

namespace phiz {

struct RemeshOptions {
  double edge_length = 0;  ///< wanted, metres, > 0
  int iterations = 5;
  double sharp_angle = 180;  ///< edges with a larger angle between their normals are kept, degrees; 180: none
};
/// Isotropic remeshing of a manifold surface (Botsch and Kobbelt 2004, CGAL); boundaries keep their shape. Texture
/// coordinates are dropped.
TriangleMesh remesh_isotropic(const TriangleMesh& mesh, const RemeshOptions& options);

/// Fewer triangles by edge collapse (Garland and Heckbert 1997, CGAL); manifold input, texture coordinates are dropped.
TriangleMesh decimate(const TriangleMesh& mesh, int target_triangles);

/// An axis-aligned box.
struct Box {
  Vector3d low = Vector3d::Constant(-1);
  Vector3d high = Vector3d::Constant(1);
};

struct PolygoniseOptions {
  double edge_length = 0;    ///< wanted edge of the result, metres, > 0
  bool improve = true;       ///< even out the triangles (isotropic remeshing, then projection back)
  int projection_steps = 6;  ///< Newton steps of each vertex to the zero set
  /// Bound on |gradient of f| where |f| is large: lets far blocks of the lattice be skipped after one evaluation. 0:
  /// evaluate everywhere.
  double lipschitz = 0;
};
/// The zero set of f (negative inside, continuous, roughly distance-like; called from several threads) inside of the
/// box, as a closed manifold outward surface: marching tetrahedra on a body-centred lattice. f must be positive on the
/// box's faces; throws phiz::Error(bad_input) otherwise, or when f is nowhere negative or not finite.
TriangleMesh polygonise(const std::function<double(const Vector3d&)>& f, const Box& box,
                        const PolygoniseOptions& options);

}  // namespace phiz
