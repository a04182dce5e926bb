// SPDX-License-Identifier: GPL-3.0-or-later
/// Connectivity questions on triangles and tets; no geometry involved. Indices must be valid (see validate.h).
#pragma once

#include <vector>

#include "phiz/geometry/mesh.h"

namespace phiz {

/// Every edge belongs to at least two triangles.
bool is_closed(const MatrixX3i& F);
/// No edge belongs to more than two triangles.
bool is_edge_manifold(const MatrixX3i& F);
/// The triangles round each vertex form one fan (open or closed).
bool is_vertex_manifold(const MatrixX3i& F);
/// Neighbours run along their common edge in opposite directions.
bool is_oriented(const MatrixX3i& F);

/// Undirected edges (low vertex, high vertex), sorted, each once.
MatrixX2i edges(const MatrixX3i& F);
/// The six edges of every tet, each once, sorted.
MatrixX2i tet_edges(const MatrixX4i& T);

/// Directed boundary edges chained into loops of vertices, in the direction of their triangles (the surface lies to the
/// left seen from outside). Each loop starts at its lowest vertex; loops are sorted by that vertex. Where loops touch
/// in a vertex they are split there.
std::vector<std::vector<int>> boundary_loops(const MatrixX3i& F);

/// Component number per triangle (connected through shared vertices), counted from 0 in order of first triangle.
VectorXi triangle_components(const MatrixX3i& F);
/// Component number per tet (connected through shared faces), counted from 0 in order of first tet.
VectorXi tet_components(const MatrixX4i& T);

/// The three neighbours per triangle: N(f, k) lies across the edge F(f, k) - F(f, k+1); -1 at a boundary. On a
/// non-manifold edge the first two triangles are paired.
MatrixX3i triangle_neighbours(const MatrixX3i& F);
/// The four neighbours per tet: N(t, k) lies across the face opposite to corner k; -1 at the outside.
MatrixX4i tet_neighbours(const MatrixX4i& T);

/// Neighbouring vertices of each of `vertex_count` vertices, sorted.
std::vector<std::vector<int>> vertex_neighbours(const MatrixX3i& F, int vertex_count);

/// The outside of a tet mesh: faces of exactly one tet, outward, in order of tets.
MatrixX3i boundary_triangles(const MatrixX4i& T);

/// Faces on the outside and between tets of different regions.
struct RegionFaces {
  MatrixX3i F;     ///< outward from the region `inner`
  VectorXi inner;  ///< region tag on the side that F points away from
  VectorXi outer;  ///< region tag on the other side; no_region at the outside of the mesh
  VectorXi tet;    ///< row of T on the inner side
  static constexpr int no_region = -1;
};
/// Each interface face is listed once, from the side of the tet with the lower row.
RegionFaces region_faces(const TetMesh& mesh);

/// Outward surface of the tets with region tag `region` (faces to other regions and to the outside).
MatrixX3i region_boundary(const TetMesh& mesh, int region);

/// A mesh without the vertices that its triangles do not use. `kept`: old row per new vertex.
struct CompactMesh {
  TriangleMesh mesh;
  VectorXi kept;
};
CompactMesh remove_unused_vertices(const MatrixX3d& V, const MatrixX3i& F);

}  // namespace phiz
