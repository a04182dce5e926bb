// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>

#include "phiz/core/parallel.h"
#include "phiz/geometry/spatial_query.h"
#include "phiz/geometry/surface.h"

namespace phiz {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

/// Exact tests between the triangles of one mesh; triangles that share an edge or a vertex may touch there only.
class TrianglePairTest {
 public:
  explicit TrianglePairTest(const TriangleMesh& mesh) : mesh_(mesh) {}

  bool is_degenerate(int f) const { return CGAL::collinear(point(f, 0), point(f, 1), point(f, 2)); }

  bool intersect(int f, int g) const {
    int shared = 0, in_f = 0, in_g = 0;
    int other_f = 3, other_g = 3;  // with two shared corners: what is left of 0 + 1 + 2
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        if (mesh_.F(f, i) == mesh_.F(g, j)) {
          ++shared;
          in_f = i;
          in_g = j;
          other_f -= i;
          other_g -= j;
        }
    if (shared == 0) return CGAL::do_intersect(triangle(f), triangle(g));
    if (shared == 1)
      return CGAL::do_intersect(triangle(f), opposite_side(g, in_g)) ||
             CGAL::do_intersect(triangle(g), opposite_side(f, in_f));
    if (shared == 2) {
      // Folded flat onto each other: coplanar with both other corners on the same side of the common edge.
      const Point a = point(f, (other_f + 1) % 3), b = point(f, (other_f + 2) % 3);
      const Point p = point(f, other_f), q = point(g, other_g);
      return CGAL::coplanar(a, b, p, q) && CGAL::coplanar_orientation(a, b, p, q) == CGAL::POSITIVE;
    }
    return true;
  }

 private:
  Point point(int f, int corner) const {
    const int v = mesh_.F(f, corner);
    return {mesh_.V(v, 0), mesh_.V(v, 1), mesh_.V(v, 2)};
  }
  Kernel::Triangle_3 triangle(int f) const { return {point(f, 0), point(f, 1), point(f, 2)}; }
  Kernel::Segment_3 opposite_side(int f, int corner) const {
    return {point(f, (corner + 1) % 3), point(f, (corner + 2) % 3)};
  }

  const TriangleMesh& mesh_;
};

}  // namespace

std::vector<std::pair<int, int>> self_intersections(const TriangleMesh& mesh) {
  if (mesh.F.rows() == 0) return {};
  const SurfaceQuery query(mesh);
  const TrianglePairTest test(mesh);
  std::vector<std::vector<int>> found(static_cast<std::size_t>(mesh.F.rows()));
  parallel_for(mesh.F.rows(), [&](Eigen::Index row) {
    const int f = static_cast<int>(row);
    if (test.is_degenerate(f)) return;
    const Matrix3d corners = mesh.V({mesh.F(f, 0), mesh.F(f, 1), mesh.F(f, 2)}, Eigen::all);
    for (const int g : query.triangles_in_box(corners.colwise().minCoeff(), corners.colwise().maxCoeff()))
      if (g > f && !test.is_degenerate(g) && test.intersect(f, g)) found[static_cast<std::size_t>(f)].push_back(g);
  });
  std::vector<std::pair<int, int>> pairs;
  for (std::size_t f = 0; f < found.size(); ++f)
    for (const int g : found[f]) pairs.emplace_back(static_cast<int>(f), g);
  return pairs;
}

}  // namespace phiz
