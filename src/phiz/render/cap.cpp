// SPDX-License-Identifier: GPL-3.0-or-later
// The cut of a closed surface: its section segments are constraints of a planar triangulation, whose faces count as
// inside when an odd number of segments separates them from infinity. The sections of open surfaces are closed by
// straight segments first.
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>

#include <deque>
#include <map>
#include <numeric>
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

/// The ends of the chains that segments between numbered points form, two and two; loops have none.
std::vector<std::pair<int, int>> ends_of_chains(int points, const std::vector<std::pair<int, int>>& segments) {
  std::vector<int> degree(points, 0), chain(points);
  std::iota(chain.begin(), chain.end(), 0);
  const auto root = [&](int i) {
    while (chain[i] != i) i = chain[i] = chain[chain[i]];
    return i;
  };
  for (const auto& [a, b] : segments) {
    ++degree[a];
    ++degree[b];
    chain[root(a)] = root(b);
  }
  std::map<int, std::vector<int>> ends;
  for (int i = 0; i < points; ++i)
    if (degree[i] == 1) ends[root(i)].push_back(i);
  std::vector<std::pair<int, int>> pairs;
  for (const auto& [start, two] : ends)
    if (two.size() == 2) pairs.emplace_back(two[0], two[1]);
  return pairs;
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

  std::vector<Kernel::Point_2> crossing;
  std::map<std::pair<int, int>, int> number;  // of the crossing of an edge
  std::vector<std::pair<int, int>> segments;
  for (Eigen::Index f = 0; f < surface.mesh.F.rows(); ++f) {
    std::vector<int> ends;
    for (int k = 0; k < 3; ++k) {
      int a = surface.mesh.F(f, k), b = surface.mesh.F(f, (k + 1) % 3);
      if ((height[a] <= 0) == (height[b] <= 0)) continue;
      if (a > b) std::swap(a, b);  // the same point from either triangle
      const auto [place, fresh] = number.try_emplace({a, b}, static_cast<int>(crossing.size()));
      if (fresh) {
        const double s = height[a] / (height[a] - height[b]);
        const Vector3d p = (1 - s) * V.row(a).transpose() + s * V.row(b).transpose() - point;
        crossing.emplace_back(p.dot(u), p.dot(v));
      }
      ends.push_back(place->second);
    }
    if (ends.size() == 2) segments.emplace_back(ends[0], ends[1]);
  }
  for (const auto& closing : ends_of_chains(static_cast<int>(crossing.size()), segments)) segments.push_back(closing);
  Triangulation triangulation;
  for (const auto& [a, b] : segments)
    if (crossing[a] != crossing[b]) triangulation.insert_constraint(crossing[a], crossing[b]);

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
