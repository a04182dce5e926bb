// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/geometry/validate.h"

#include <spdlog/fmt/fmt.h>

#include <Eigen/LU>
#include <algorithm>

#include "phiz/core/error.h"
#include "phiz/geometry/operators.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/topology.h"

namespace phiz {

namespace {

constexpr double farthest = 1e12;             // of a coordinate, in any unit of a file; areas and volumes stay finite
constexpr std::size_t most_corners = 10'000;  // of a polygon that is cut into triangles

template <class Points>
void require_finite(const Points& points, const char* noun, const std::string& where) {
  if (points.size() == 0 || points.cwiseAbs().template maxCoeff<Eigen::PropagateNaN>() <= farthest) return;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    if (!points.row(i).allFinite())
      reject(where, fmt::format("{} {} is not finite", noun, i), "every coordinate must be a finite number");
    const double largest = points.row(i).cwiseAbs().maxCoeff();
    if (largest > farthest)
      reject(where,
             fmt::format("{} {} has a coordinate of {:.3g}, at most {:g} is possible", noun, i, largest, farthest),
             "is the file damaged?");
  }
}

void require_index(int index, Eigen::Index count, const char* noun, Eigen::Index element, const char* target,
                   const std::string& where) {
  if (index < 0 || index >= count)
    reject(where, fmt::format("{} {} refers to {} {}, but there are {}", noun, element, target, index, count));
}

template <class Elements>
void require_elements(const Elements& E, Eigen::Index count, const char* noun, const std::string& where) {
  for (Eigen::Index e = 0; e < E.rows(); ++e)
    for (Eigen::Index k = 0; k < E.cols(); ++k) {
      require_index(E(e, k), count, noun, e, "vertex", where);
      for (Eigen::Index l = 0; l < k; ++l)
        if (E(e, k) == E(e, l))
          reject(where, fmt::format("{} {} uses vertex {} twice", noun, e, E(e, k)), "remove the degenerate element");
    }
}

}  // namespace

void validate(const TriangleMesh& mesh, const std::string& where) {
  require_finite(mesh.V, "vertex", where);
  require_finite(mesh.UV, "texture coordinate", where);
  require_elements(mesh.F, mesh.V.rows(), "triangle", where);
  if (mesh.FUV.rows() != 0 && mesh.FUV.rows() != mesh.F.rows())
    reject(where,
           fmt::format("{} triangles have texture coordinates, expected {} or none", mesh.FUV.rows(), mesh.F.rows()));
  for (Eigen::Index f = 0; f < mesh.FUV.rows(); ++f)
    for (int k = 0; k < 3; ++k)
      require_index(mesh.FUV(f, k), mesh.UV.rows(), "triangle", f, "texture coordinate", where);
}

void validate(const PolygonMesh& mesh, const std::string& where) {
  require_finite(mesh.V, "vertex", where);
  require_finite(mesh.UV, "texture coordinate", where);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto element = static_cast<Eigen::Index>(f);
    const auto& face = mesh.faces[f];
    if (face.size() < 3) reject(where, fmt::format("face {} has {} corners, expected at least 3", f, face.size()));
    if (face.size() > most_corners)
      reject(where, fmt::format("face {} has {} corners, expected at most {}", f, face.size(), most_corners),
             "cut it into smaller ones");
    for (const int v : face) require_index(v, mesh.V.rows(), "face", element, "vertex", where);
    std::vector<int> sorted = face;
    std::sort(sorted.begin(), sorted.end());
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
    if (twice != sorted.end())
      reject(where, fmt::format("face {} uses vertex {} twice", f, *twice), "remove the degenerate face");
  }
  if (!mesh.face_uvs.empty() && mesh.face_uvs.size() != mesh.faces.size())
    reject(where, fmt::format("{} faces have texture coordinates, expected {} or none", mesh.face_uvs.size(),
                              mesh.faces.size()));
  for (std::size_t f = 0; f < mesh.face_uvs.size(); ++f) {
    const auto& uvs = mesh.face_uvs[f];
    if (uvs.size() != mesh.faces[f].size() && !uvs.empty())
      reject(where,
             fmt::format("face {} has {} corners but {} texture coordinates", f, mesh.faces[f].size(), uvs.size()));
    for (const int uv : uvs)
      require_index(uv, mesh.UV.rows(), "face", static_cast<Eigen::Index>(f), "texture coordinate", where);
  }
  if (!mesh.face_group.empty() && mesh.face_group.size() != mesh.faces.size())
    reject(where, fmt::format("{} faces have a group, expected {} or none", mesh.face_group.size(), mesh.faces.size()));
  for (std::size_t f = 0; f < mesh.face_group.size(); ++f)
    require_index(mesh.face_group[f], static_cast<Eigen::Index>(mesh.groups.size()), "face",
                  static_cast<Eigen::Index>(f), "group", where);
}

void validate(const TetMesh& mesh, const std::string& where) {
  require_finite(mesh.V, "vertex", where);
  require_elements(mesh.T, mesh.V.rows(), "tet", where);
  if (mesh.region.size() != mesh.T.rows())
    reject(where, fmt::format("{} tets have a region tag, expected {}", mesh.region.size(), mesh.T.rows()));
  for (Eigen::Index t = 0; t < mesh.T.rows(); ++t) {
    Matrix3d Dm;
    for (int k = 0; k < 3; ++k) Dm.col(k) = (mesh.V.row(mesh.T(t, k + 1)) - mesh.V.row(mesh.T(t, 0))).transpose();
    const double det = Dm.determinant();
    const double size = Dm.colwise().norm().maxCoeff();
    if (!(det > 1e-13 * size * size * size))
      reject(where,
             fmt::format("tet {} is {} (volume {:.3g} cubic metres)", t,
                         det < -1e-13 * size * size * size ? "inverted" : "flat", det / 6),
             "tets must be positively oriented: det[x1-x0, x2-x0, x3-x0] > 0");
  }
}

void require_no_degenerate_triangles(const TriangleMesh& mesh, const std::string& where, double min_area) {
  const VectorXd areas = triangle_areas(mesh.V, mesh.F);
  for (Eigen::Index f = 0; f < areas.size(); ++f)
    if (!(areas[f] >= min_area))
      reject(where, fmt::format("triangle {} is degenerate (area {:.3g} square metres)", f, areas[f]),
             "remove or collapse it");
}

void require_closed_manifold(const TriangleMesh& mesh, const std::string& where) {
  if (mesh.F.rows() == 0) reject(where, "the surface has no triangles");
  if (!is_edge_manifold(mesh.F))
    reject(where, "an edge belongs to more than two triangles", "the surface must be manifold");
  const auto loops = boundary_loops(mesh.F);
  if (!loops.empty())
    reject(where,
           fmt::format("the surface has {} hole(s), the first along edge {}-{}", loops.size(), loops[0][0],
                       loops[0].size() > 1 ? loops[0][1] : loops[0][0]),
           "fill the holes");
  if (!is_oriented(mesh.F)) reject(where, "neighbouring triangles face opposite ways", "orient all triangles outward");
  if (!is_vertex_manifold(mesh.F)) reject(where, "parts of the surface touch in a single vertex", "split that vertex");
}

void require_no_self_intersections(const TriangleMesh& mesh, const std::string& where) {
  const auto pairs = self_intersections(mesh);
  if (!pairs.empty())
    reject(where,
           fmt::format("triangles {} and {} intersect ({} such pairs)", pairs[0].first, pairs[0].second, pairs.size()),
           "mend the surface so that it does not cross itself");
}

}  // namespace phiz
