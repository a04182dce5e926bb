// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <numeric>

#include "phiz/geometry/surface.h"

namespace phiz {

namespace {

using PolygonCorners = std::array<int, 3>;  // corners of a polygon, not vertices

Vector3d polygon_normal(const std::vector<Vector3d>& points) {
  Vector3d normal = Vector3d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i)
    normal += (points[i] - points[0]).cross(points[(i + 1) % points.size()] - points[0]);
  return normal;
}

double turn(const std::vector<Vector3d>& points, const Vector3d& normal, int a, int b, int c) {
  const Vector3d& p = points[static_cast<std::size_t>(a)];
  return (points[static_cast<std::size_t>(b)] - p).cross(points[static_cast<std::size_t>(c)] - p).dot(normal);
}

std::vector<PolygonCorners> split_quad(const std::vector<Vector3d>& points, const Vector3d& normal) {
  const bool first_unfolded = turn(points, normal, 0, 1, 2) > 0 && turn(points, normal, 0, 2, 3) > 0;
  const bool second_unfolded = turn(points, normal, 0, 1, 3) > 0 && turn(points, normal, 1, 2, 3) > 0;
  const bool first_shorter = (points[0] - points[2]).squaredNorm() <= (points[1] - points[3]).squaredNorm();
  if (first_unfolded == second_unfolded ? first_shorter : first_unfolded) return {{{0, 1, 2}}, {{0, 2, 3}}};
  return {{{0, 1, 3}}, {{1, 2, 3}}};
}

/// What is known of a corner of a polygon that is being cut.
struct Ear {
  double score = 0;  // the larger, the sooner the corner is cut; below zero when it is no ear
  int blocker = -1;  // a corner inside the triangle, without which it might be an ear
};

/// Cuts the ear with the widest smallest angle first; a polygon without a proper ear is cut at its least bad corner.
std::vector<PolygonCorners> clip_ears(const std::vector<Vector3d>& points, const Vector3d& normal) {
  std::vector<int> left(points.size());
  std::iota(left.begin(), left.end(), 0);
  const auto look_at = [&](std::size_t i) {
    const int a = left[(i + left.size() - 1) % left.size()], b = left[i], c = left[(i + 1) % left.size()];
    const Vector3d &A = points[static_cast<std::size_t>(a)], &B = points[static_cast<std::size_t>(b)],
                   &C = points[static_cast<std::size_t>(c)];
    const double area = turn(points, normal, a, b, c);
    Ear ear;
    if (area > 0) {
      const auto inside = [&](int p) {
        return p != a && p != b && p != c && turn(points, normal, a, b, p) >= 0 && turn(points, normal, b, c, p) >= 0 &&
               turn(points, normal, c, a, p) >= 0;
      };
      const auto found = std::find_if(left.begin(), left.end(), inside);
      if (found != left.end()) ear.blocker = *found;
    }
    const double edges_squared = (A - B).squaredNorm() + (B - C).squaredNorm() + (C - A).squaredNorm();
    const double shape = edges_squared > 0 ? area / (edges_squared * normal.norm() + 1e-300) : 0;
    ear.score = area > 0 && ear.blocker < 0 ? shape : shape - 1;
    return ear;
  };
  std::vector<Ear> ears;
  for (std::size_t i = 0; i < left.size(); ++i) ears.push_back(look_at(i));
  std::vector<PolygonCorners> triangles;
  while (left.size() > 3) {
    const auto best = static_cast<std::size_t>(
        std::max_element(ears.begin(), ears.end(), [](const Ear& a, const Ear& b) { return a.score < b.score; }) -
        ears.begin());
    const int cut = left[best];
    triangles.push_back({left[(best + left.size() - 1) % left.size()], cut, left[(best + 1) % left.size()]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(best));
    ears.erase(ears.begin() + static_cast<std::ptrdiff_t>(best));
    const std::size_t after = best % left.size(), before = (best + left.size() - 1) % left.size();
    for (std::size_t i = 0; i < left.size(); ++i)
      if (i == before || i == after || ears[i].blocker == cut) ears[i] = look_at(i);
  }
  triangles.push_back({left[0], left[1], left[2]});
  return triangles;
}

}  // namespace

TriangleMesh triangulate(const PolygonMesh& mesh, std::vector<int>* face_of_triangle) {
  std::vector<std::array<int, 3>> F, FUV;
  std::vector<int> owner;
  bool with_uvs = !mesh.face_uvs.empty();
  for (const auto& uvs : mesh.face_uvs) with_uvs = with_uvs && !uvs.empty();
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto& face = mesh.faces[f];
    std::vector<PolygonCorners> triangles{{{0, 1, 2}}};
    if (face.size() > 3) {
      std::vector<Vector3d> points;
      for (const int v : face) points.emplace_back(mesh.V.row(v));
      const Vector3d normal = polygon_normal(points);
      triangles = face.size() == 4 ? split_quad(points, normal) : clip_ears(points, normal);
    }
    for (const PolygonCorners& corners : triangles) {
      const auto pick = [&corners](const std::vector<int>& list) {
        return std::array<int, 3>{list[static_cast<std::size_t>(corners[0])],
                                  list[static_cast<std::size_t>(corners[1])],
                                  list[static_cast<std::size_t>(corners[2])]};
      };
      F.push_back(pick(face));
      if (with_uvs) FUV.push_back(pick(mesh.face_uvs[f]));
      owner.push_back(static_cast<int>(f));
    }
  }
  const auto to_matrix = [](const std::vector<std::array<int, 3>>& rows) {
    MatrixX3i M(static_cast<Eigen::Index>(rows.size()), 3);
    for (std::size_t i = 0; i < rows.size(); ++i)
      M.row(static_cast<Eigen::Index>(i)) << rows[i][0], rows[i][1], rows[i][2];
    return M;
  };
  if (face_of_triangle) *face_of_triangle = std::move(owner);
  return {mesh.V, to_matrix(F), with_uvs ? mesh.UV : MatrixX2d{}, to_matrix(FUV)};
}

}  // namespace phiz
