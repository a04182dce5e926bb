// SPDX-License-Identifier: GPL-3.0-or-later
/// Conversion to and from CGAL's half-edge mesh (not a public header).
#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

#include "phiz/core/error.h"
#include "phiz/geometry/mesh.h"

namespace phiz {

using CgalKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalMesh = CGAL::Surface_mesh<CgalKernel::Point_3>;

inline CgalMesh to_cgal(const TriangleMesh& mesh, const char* where) {
  CgalMesh result;
  using Vertex = CgalMesh::Vertex_index;
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) result.add_vertex({mesh.V(v, 0), mesh.V(v, 1), mesh.V(v, 2)});
  for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
    const auto corner = [&](int k) { return Vertex(static_cast<CgalMesh::size_type>(mesh.F(f, k))); };
    if (result.add_face(corner(0), corner(1), corner(2)) == CgalMesh::null_face())
      reject(where, "triangle " + std::to_string(f) + " makes the surface non-manifold or inconsistently oriented",
             "split the vertices or reverse the triangle");
  }
  return result;
}

/// Compacts the mesh; vertices without triangles are dropped.
inline TriangleMesh from_cgal(CgalMesh& mesh) {
  for (const auto v : mesh.vertices())
    if (mesh.is_isolated(v)) mesh.remove_vertex(v);
  mesh.collect_garbage();
  TriangleMesh result;
  result.V.resize(static_cast<Eigen::Index>(mesh.number_of_vertices()), 3);
  result.F.resize(static_cast<Eigen::Index>(mesh.number_of_faces()), 3);
  for (const auto v : mesh.vertices()) {
    const auto& p = mesh.point(v);
    result.V.row(static_cast<Eigen::Index>(v.idx())) << p.x(), p.y(), p.z();
  }
  for (const auto f : mesh.faces()) {
    int k = 0;
    for (const auto v : mesh.vertices_around_face(mesh.halfedge(f)))
      result.F(static_cast<Eigen::Index>(f.idx()), k++) = static_cast<int>(v.idx());
  }
  return result;
}

}  // namespace phiz
