// SPDX-License-Identifier: GPL-3.0-or-later
/// Small geometry of surfaces: triangulation of polygons, normals, areas, volume, self-intersections.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "phiz/geometry/mesh.h"

namespace phiz {

/// Triangles of a polygon mesh: quads along the shorter diagonal that keeps both triangles unfolded, larger polygons by
/// ear clipping in their mean plane. Texture coordinates follow. `face_of_triangle`, when given, receives the polygon
/// of each triangle.
TriangleMesh triangulate(const PolygonMesh& mesh, std::vector<int>* face_of_triangle = nullptr);

/// Cross product of the edges: twice the area times the unit normal, m x 3.
MatrixX3d triangle_area_normals(const MatrixX3d& V, const MatrixX3i& F);
/// Unit normals per triangle; zero for degenerate triangles.
MatrixX3d triangle_normals(const MatrixX3d& V, const MatrixX3i& F);
/// Areas, square metres.
VectorXd triangle_areas(const MatrixX3d& V, const MatrixX3i& F);
/// Angle-weighted unit normals per vertex; zero for vertices without triangles.
MatrixX3d vertex_normals(const MatrixX3d& V, const MatrixX3i& F);

/// Volume enclosed by a closed surface, positive when triangles face outward, cubic metres.
double signed_volume(const MatrixX3d& V, const MatrixX3i& F);
/// Centre of the enclosed volume.
Vector3d volume_centroid(const MatrixX3d& V, const MatrixX3i& F);
double mean_edge_length(const MatrixX3d& V, const MatrixX3i& F);

/// Points as the rows of a matrix.
MatrixX3d rows_of(const std::vector<Vector3d>& points);

/// Up to `count` rows of points (at least one), each as far from those before it as any is (farthest point sampling);
/// fewer when points coincide.
std::vector<int> farthest_points(const MatrixX3d& points, Eigen::Index count);

/// All meshes as one, vertices and triangles in order.
TriangleMesh joined(std::span<const TriangleMesh> meshes);

/// The closed surface of a sheet that has a thickness: the sheet, itself moved against its normals, and a band along
/// every boundary. Vertices: those of the sheet, then the moved ones in the same order.
TriangleMesh thickened(const TriangleMesh& sheet, double thickness);

/// Pairs of triangles that intersect other than in a shared edge or vertex, sorted. Exact predicates (CGAL).
std::vector<std::pair<int, int>> self_intersections(const TriangleMesh& mesh);

}  // namespace phiz
