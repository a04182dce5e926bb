// SPDX-License-Identifier: GPL-3.0-or-later
// The cut of a closed surface: its section segments are constraints of a planar triangulation, whose faces count as
// inside when an odd number of segments separates them from infinity.
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>

#include <deque>
#include <map>
#include <utility>
#include <vector>

#include "phiz/core/error.h"
#include "phiz/render/cut.h"

namespace phiz {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_2<Kernel>;
using FaceBase =
    CGAL::Constrained_triangulation_face_base_2<Kernel, CGAL::Triangulation_face_base_with_info_2<int, Kernel>>;
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
                                               CGAL::Exact_predicates_tag>;

/// Numbers the faces by how many constraints separate them from infinity.
void number_faces(Triangulation& triangulation) {
  for (const auto face : triangulation.all_face_handles()) face->info() = -1;
  std::deque<std::pair<Triangulation::Face_handle, int>> border{{triangulation.infinite_face(), 0}};
  while (!border.empty()) {
    const auto [start, depth] = border.front();
    border.pop_front();
    if (start->info() >= 0) continue;
    std::deque<Triangulation::Face_handle> same{start};
    start->info() = depth;
    while (!same.empty()) {
      const Triangulation::Face_handle face = same.front();
      same.pop_front();
      for (int k = 0; k < 3; ++k) {
        const Triangulation::Face_handle next = face->neighbor(k);
        if (next->info() >= 0) continue;
        if (triangulation.is_constrained({face, k})) {
          border.emplace_back(next, depth + 1);
        } else {
          next->info() = depth;
          same.push_back(next);
        }
      }
    }
  }
}

}  // namespace

Surface cap(const Surface& surface, const CutPlane& world_plane) {
  const double length = world_plane.normal.norm();
  if (!(length > 0)) reject("cut plane", "it has no direction", "give a normal that is not zero");
  const Vector3d point = surface.transform.inverse() * world_plane.point;
  const Vector3d normal = surface.transform.linear().transpose() * (world_plane.normal / length);
  const Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
  const MatrixX3d& V = surface.mesh.V;
  const VectorXd height = (V.rowwise() - point.transpose()) * normal;

  Triangulation triangulation;
  for (Eigen::Index f = 0; f < surface.mesh.F.rows(); ++f) {
    std::vector<Kernel::Point_2> ends;
    for (int k = 0; k < 3; ++k) {
      int a = surface.mesh.F(f, k), b = surface.mesh.F(f, (k + 1) % 3);
      if ((height[a] <= 0) == (height[b] <= 0)) continue;
      if (a > b) std::swap(a, b);  // the same point from either triangle
      const double s = height[a] / (height[a] - height[b]);
      const Vector3d p = (1 - s) * V.row(a).transpose() + s * V.row(b).transpose() - point;
      ends.emplace_back(p.dot(u), p.dot(v));
    }
    if (ends.size() == 2 && ends[0] != ends[1]) triangulation.insert_constraint(ends[0], ends[1]);
  }

  Surface result;
  result.name = surface.name + " cut";
  result.transform = surface.transform;
  result.material = surface.material;
  result.flat = true;
  if (triangulation.dimension() < 2) {
    result.mesh.V.resize(0, 3);
    result.mesh.F.resize(0, 3);
    return result;
  }
  number_faces(triangulation);
  std::map<Triangulation::Vertex_handle, int> row;
  std::vector<Vector3d> points;
  std::vector<int> corners;
  for (const auto face : triangulation.finite_face_handles()) {
    if (face->info() % 2 == 0) continue;
    for (int k = 0; k < 3; ++k) {
      const auto [place, fresh] = row.try_emplace(face->vertex(k), static_cast<int>(points.size()));
      if (fresh) points.emplace_back(point + u * face->vertex(k)->point().x() + v * face->vertex(k)->point().y());
      corners.push_back(place->second);
    }
  }
  result.mesh.V.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i)
    result.mesh.V.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
  result.mesh.F.resize(static_cast<Eigen::Index>(corners.size() / 3), 3);
  for (std::size_t i = 0; i < corners.size(); ++i)
    result.mesh.F(static_cast<Eigen::Index>(i / 3), static_cast<Eigen::Index>(i % 3)) = corners[i];
  return result;
}

}  // namespace phiz
