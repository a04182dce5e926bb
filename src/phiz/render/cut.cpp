// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/render/cut.h"

#include <array>
#include <cmath>
#include <utility>

#include "phiz/core/error.h"
#include "phiz/render/materials.h"

namespace phiz {

namespace {

CutPlane checked(const CutPlane& plane) {
  const double length = plane.normal.norm();
  if (!(length > 0 && std::isfinite(length) && plane.point.allFinite()))
    reject("cut plane", "it has no direction or is not finite", "give a normal that is not zero");
  return {plane.point, plane.normal / length};
}

/// The plane seen from the frame of a surface.
CutPlane to_local(const CutPlane& plane, const Eigen::Isometry3d& transform) {
  return {transform.inverse() * plane.point, transform.linear().transpose() * plane.normal};
}

/// Vertices of the cut surface: an old one, or a point on the edge between two.
struct CutVertices {
  std::vector<std::array<int, 2>> ends;
  std::vector<double> along;
  std::vector<int> kept;  // new row per old vertex, -1 none yet
  std::map<std::pair<int, int>, int> crossing;

  explicit CutVertices(Eigen::Index count) : kept(static_cast<std::size_t>(count), -1) {}

  int old_vertex(int v) {
    if (kept[v] < 0) {
      kept[v] = static_cast<int>(ends.size());
      ends.push_back({v, v});
      along.push_back(0);
    }
    return kept[v];
  }
  int between(int a, int b, const VectorXd& height) {
    if (a > b) std::swap(a, b);
    const auto [place, fresh] = crossing.try_emplace({a, b}, static_cast<int>(ends.size()));
    if (fresh) {
      ends.push_back({a, b});
      along.push_back(height[a] / (height[a] - height[b]));
    }
    return place->second;
  }
  MatrixX3d values(const MatrixX3d& old) const {
    if (old.rows() == 0) return old;
    MatrixX3d result(static_cast<Eigen::Index>(ends.size()), 3);
    for (std::size_t i = 0; i < ends.size(); ++i)
      result.row(static_cast<Eigen::Index>(i)) = (1 - along[i]) * old.row(ends[i][0]) + along[i] * old.row(ends[i][1]);
    return result;
  }
};

}  // namespace

Surface cut_surface(const Surface& surface, const CutPlane& world_plane) {
  const CutPlane plane = to_local(checked(world_plane), surface.transform);
  const VectorXd height = (surface.mesh.V.rowwise() - plane.point.transpose()) * plane.normal;
  CutVertices vertices(surface.mesh.V.rows());
  std::vector<std::array<int, 3>> triangles;
  std::vector<std::uint8_t> edges;
  for (Eigen::Index f = 0; f < surface.mesh.F.rows(); ++f) {
    const unsigned drawn = surface.wireframe.edges.empty() ? 7U : surface.wireframe.edges[f];
    std::array<int, 4> polygon{};
    std::array<bool, 4> edge_drawn{};  // of the edge that starts at the corner
    int corners = 0;
    for (int k = 0; k < 3; ++k) {
      const int a = surface.mesh.F(f, k), b = surface.mesh.F(f, (k + 1) % 3);
      const bool inside = height[a] <= 0, next_inside = height[b] <= 0, line = (drawn >> k & 1U) != 0;
      if (inside) {
        edge_drawn[corners] = line;
        polygon[corners++] = vertices.old_vertex(a);
      }
      if (inside != next_inside) {
        edge_drawn[corners] = !inside && line;
        polygon[corners++] = vertices.between(a, b, height);
      }
    }
    if (corners < 3) continue;
    triangles.push_back({polygon[0], polygon[1], polygon[2]});
    edges.push_back(static_cast<std::uint8_t>((edge_drawn[0] ? 1 : 0) | (edge_drawn[1] ? 2 : 0) |
                                              (corners == 3 && edge_drawn[2] ? 4 : 0)));
    if (corners == 4) {
      triangles.push_back({polygon[0], polygon[2], polygon[3]});
      edges.push_back(static_cast<std::uint8_t>((edge_drawn[2] ? 2 : 0) | (edge_drawn[3] ? 4 : 0)));
    }
  }
  Surface result = surface;
  result.mesh = {};
  result.mesh.V = vertices.values(surface.mesh.V);
  result.mesh.F.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (int k = 0; k < 3; ++k) result.mesh.F(static_cast<Eigen::Index>(i), k) = triangles[i][k];
  result.normals = vertices.values(surface.normals);
  result.colour = vertices.values(surface.colour);
  result.fibre = vertices.values(surface.fibre);
  result.rest = vertices.values(surface.rest.rows() > 0 ? surface.rest : surface.mesh.V);
  result.wireframe.edges = std::move(edges);
  return result;
}

Surface cross_section(const TetMesh& mesh, const CutPlane& plane, const std::map<int, Vector3d>& colours, bool cells,
                      const Vector3d& other) {
  MatrixX3d tet_colours(mesh.T.rows(), 3);
  for (Eigen::Index t = 0; t < mesh.T.rows(); ++t) {
    const auto colour = colours.find(mesh.region.size() == mesh.T.rows() ? mesh.region[t] : 0);
    tet_colours.row(t) = (colour == colours.end() ? other : colour->second).transpose();
  }
  return cross_section(mesh, plane, tet_colours, cells);
}

Surface cross_section(const TetMesh& mesh, const CutPlane& asked, const MatrixX3d& tet_colours, bool cells) {
  const CutPlane plane = checked(asked);
  const VectorXd height = (mesh.V.rowwise() - plane.point.transpose()) * plane.normal;
  std::vector<Vector3d> points, point_colours;
  std::vector<std::array<int, 3>> triangles;
  std::vector<std::uint8_t> edges;
  for (Eigen::Index t = 0; t < mesh.T.rows(); ++t) {
    std::array<int, 4> below{}, above{};
    int belows = 0, aboves = 0;
    for (int k = 0; k < 4; ++k) {
      const int v = mesh.T(t, k);
      if (height[v] <= 0)
        below[belows++] = v;
      else
        above[aboves++] = v;
    }
    if (belows == 0 || aboves == 0) continue;
    const auto crossing = [&](int a, int b) -> Vector3d {
      const double s = height[a] / (height[a] - height[b]);
      return (1 - s) * mesh.V.row(a) + s * mesh.V.row(b);
    };
    // Round the section: with two corners on either side the four crossings go b0a0, b0a1, b1a1, b1a0.
    std::array<Vector3d, 4> polygon;
    int corners = 0;
    if (belows == 2) {
      for (const auto& [i, j] : {std::pair{0, 0}, std::pair{0, 1}, std::pair{1, 1}, std::pair{1, 0}})
        polygon[corners++] = crossing(below[i], above[j]);
    } else {
      for (int i = 0; i < belows; ++i)
        for (int j = 0; j < aboves; ++j) polygon[corners++] = crossing(below[i], above[j]);
    }
    const bool turned = (polygon[1] - polygon[0]).cross(polygon[2] - polygon[0]).dot(plane.normal) < 0;
    const int first = static_cast<int>(points.size());
    for (int k = 0; k < corners; ++k) {
      points.push_back(polygon[turned ? corners - 1 - k : k]);
      point_colours.emplace_back(tet_colours.row(t));
    }
    triangles.push_back({first, first + 1, first + 2});
    edges.push_back(corners == 3 ? 7 : 3);
    if (corners == 4) {
      triangles.push_back({first, first + 2, first + 3});
      edges.push_back(6);
    }
  }
  Surface section;
  section.name = "cross-section";
  section.mesh.V.resize(static_cast<Eigen::Index>(points.size()), 3);
  section.colour.resize(section.mesh.V.rows(), 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    section.mesh.V.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
    section.colour.row(static_cast<Eigen::Index>(i)) = point_colours[i].transpose();
  }
  section.mesh.F.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (int k = 0; k < 3; ++k) section.mesh.F(static_cast<Eigen::Index>(i), k) = triangles[i][k];
  section.material = section_material();
  section.flat = true;
  section.wireframe.shown = cells;
  section.wireframe.width = 0.8;
  section.wireframe.edges = std::move(edges);
  return section;
}

}  // namespace phiz
