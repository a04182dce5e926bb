// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/skin/uv.h"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "phiz/anatomy/builtin/skin/topology.h"
#include "phiz/core/error.h"

namespace phiz {
namespace {

constexpr double pi = std::numbers::pi;

/// Where an island goes in the unit square.
struct Box {
  SkinIsland island;
  double u0, v0, u1, v1;
};
constexpr Box boxes[] = {
    {SkinIsland::outside, 0.01, 0.19, 0.99, 0.99},       {SkinIsland::mouth, 0.01, 0.01, 0.18, 0.18},
    {SkinIsland::right_socket, 0.20, 0.01, 0.31, 0.18},  {SkinIsland::left_socket, 0.33, 0.01, 0.44, 0.18},
    {SkinIsland::right_ear, 0.46, 0.01, 0.59, 0.18},     {SkinIsland::left_ear, 0.61, 0.01, 0.74, 0.18},
    {SkinIsland::right_nostril, 0.76, 0.01, 0.81, 0.18}, {SkinIsland::left_nostril, 0.83, 0.01, 0.88, 0.18},
    {SkinIsland::foot, 0.90, 0.01, 0.99, 0.18},
};

/// One island as a planar graph: texture vertices, each a copy of a cage vertex.
struct IslandGraph {
  std::vector<int> faces;                   // rows of the cage's faces
  std::vector<std::array<int, 4>> corners;  // texture vertices per face
  std::vector<int> source;                  // cage vertex per texture vertex
};

/// Vertices along the cut from the foot of the neck up the back to the top of the head, without its upper end.
std::vector<char> cut_vertices() {
  const SkinTopology& t = skin_topology();
  std::vector<char> cut(t.vertex_count(), 0);
  for (int j = 0; j <= SkinTopology::rows; ++j)
    if (t.sheet(SkinTopology::columns, j) >= 0) cut[t.sheet(SkinTopology::columns, j)] = 1;
  for (int v = SkinTopology::crown_rows / 2 + 1; v <= SkinTopology::crown_rows; ++v) cut[t.crown(0, v)] = 1;
  return cut;
}

IslandGraph collect(SkinIsland island) {
  const SkinTopology& t = skin_topology();
  static const std::vector<char> cut = cut_vertices();
  IslandGraph graph;
  std::map<std::pair<int, int>, int> ids;  // (cage vertex, side of the cut)
  const int half = static_cast<int>(t.faces().size()) / 2;
  for (int f = 0; f < static_cast<int>(t.faces().size()); ++f) {
    if (t.islands()[f] != island) continue;
    graph.faces.push_back(f);
    std::array<int, 4> corner{};
    for (int k = 0; k < 4; ++k) {
      const int v = t.faces()[f][k];
      const int side = island == SkinIsland::outside && cut[v] && f >= half ? 1 : 0;
      const auto [it, fresh] = ids.try_emplace({v, side}, static_cast<int>(graph.source.size()));
      if (fresh) graph.source.push_back(v);
      corner[k] = it->second;
    }
    graph.corners.push_back(corner);
  }
  return graph;
}

/// Boundary loops of the graph, the surface to their left.
std::vector<std::vector<int>> loops_of(const IslandGraph& graph) {
  std::map<std::pair<int, int>, int> directed;
  for (const auto& c : graph.corners)
    for (int k = 0; k < 4; ++k) directed[{c[k], c[(k + 1) % 4]}] = 1;
  std::map<int, int> next;
  for (const auto& [edge, one] : directed)
    if (!directed.contains({edge.second, edge.first})) next[edge.first] = edge.second;
  std::vector<std::vector<int>> loops;
  while (!next.empty()) {
    std::vector<int> loop;
    for (int v = next.begin()->first; next.contains(v);) {
      loop.push_back(v);
      const int following = next[v];
      next.erase(v);
      v = following;
    }
    loops.push_back(loop);
  }
  return loops;
}

/// Angles of the boundary of the outside: the foot of the neck below, the two banks of the cut up the sides to the top.
double outside_angle(int cage_vertex, bool right_bank) {
  const SkinTopology& t = skin_topology();
  constexpr double foot_end = 65;  // degrees from straight down
  for (int i = 0; i <= SkinTopology::columns; ++i) {
    const int v = t.sheet(i, 0);
    const double angle = foot_end * i / SkinTopology::columns;
    if (v == cage_vertex) return (-90 + (right_bank ? -angle : angle)) * pi / 180;
    if (t.mirror(v) == cage_vertex) return (-90 - angle) * pi / 180;
  }
  std::vector<int> bank;
  for (int j = 0; j <= SkinTopology::rows; ++j)
    if (t.sheet(SkinTopology::columns, j) >= 0) bank.push_back(t.sheet(SkinTopology::columns, j));
  for (int v = SkinTopology::crown_rows - 1; v >= SkinTopology::crown_rows / 2; --v) bank.push_back(t.crown(0, v));
  const auto it = std::find(bank.begin(), bank.end(), cage_vertex);
  if (it == bank.end()) fail("the texture seam of the skin does not match its boundary");
  const double share = static_cast<double>(it - bank.begin()) / static_cast<double>(bank.size() - 1);
  const double angle = foot_end + share * (180 - foot_end);
  return (-90 + (right_bank ? -angle : angle)) * pi / 180;
}

/// A point of the unit superellipse (strictly convex, fills the square well).
Vector2d rounded_square(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return Vector2d(c, s) * std::pow(std::pow(std::abs(c), 2.6) + std::pow(std::abs(s), 2.6), -1 / 2.6);
}

/// Texture coordinates in [-1, 1]^2: boundary on a convex curve, every other vertex at the weighted mean of its
/// neighbours.
MatrixX2d embed(const IslandGraph& graph, SkinIsland island, const MatrixX3d& V) {
  const int n = static_cast<int>(graph.source.size());
  const auto loops = loops_of(graph);
  const auto longest =
      std::max_element(loops.begin(), loops.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
  MatrixX2d UV = MatrixX2d::Zero(n, 2);
  std::vector<char> fixed(n, 0);
  std::map<int, int> copies;
  for (int v = 0; v < n; ++v) copies.try_emplace(graph.source[v], v);
  for (std::size_t k = 0; k < longest->size(); ++k) {
    const int v = (*longest)[k];
    fixed[v] = 1;
    if (island == SkinIsland::outside) {
      UV.row(v) = rounded_square(outside_angle(graph.source[v], copies[graph.source[v]] != v)).transpose();
    } else {
      const double angle = 2 * pi * static_cast<double>(k) / static_cast<double>(longest->size()) + pi / 2;
      UV.row(v) << std::cos(angle), std::sin(angle);
    }
  }
  // Conductance of an edge: width of the faces beside it over its length.
  std::map<std::pair<int, int>, double> conductance;
  for (std::size_t f = 0; f < graph.faces.size(); ++f) {
    const auto& c = graph.corners[f];
    const auto p = [&](int k) -> Vector3d { return V.row(graph.source[c[k % 4]]); };
    const double area = 0.5 * (p(2) - p(0)).cross(p(3) - p(1)).norm();
    for (int k = 0; k < 4; ++k) {
      const auto edge = std::minmax(c[k], c[(k + 1) % 4]);
      conductance[edge] += std::clamp(area / (p(k + 1) - p(k)).squaredNorm(), 0.15, 6.0);
    }
  }
  // Inner holes are closed by one vertex each.
  int hole = n;
  for (const auto& loop : loops) {
    if (&loop == &*longest) continue;
    for (int v : loop) conductance[{v, hole}] = 1;
    ++hole;
  }
  std::vector<Eigen::Triplet<double>> entries;
  MatrixX2d b = MatrixX2d::Zero(hole, 2);
  const auto is_fixed = [&](int v) { return v < n && fixed[v]; };
  for (const auto& [edge, w] : conductance)
    for (const auto& [v, other] : {edge, std::pair(edge.second, edge.first)}) {
      if (is_fixed(v)) continue;
      entries.emplace_back(v, v, w);
      if (is_fixed(other))
        b.row(v) += w * UV.row(other);
      else
        entries.emplace_back(v, other, -w);
    }
  for (int v = 0; v < n; ++v)
    if (fixed[v]) {
      entries.emplace_back(v, v, 1.0);
      b.row(v) = UV.row(v);
    }
  Eigen::SparseMatrix<double> A(hole, hole);
  A.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(A);
  if (solver.info() != Eigen::Success) fail("the texture map of the skin could not be computed");
  return MatrixX2d(solver.solve(b)).topRows(n);
}

}  // namespace

void unwrap_skin(PolygonMesh& mesh) {
  mesh.face_uvs.assign(mesh.faces.size(), {});
  std::vector<Vector2d> all;
  for (const Box& box : boxes) {
    const IslandGraph graph = collect(box.island);
    const MatrixX2d UV = embed(graph, box.island, mesh.V);
    const int first = static_cast<int>(all.size());
    for (Eigen::Index v = 0; v < UV.rows(); ++v)
      all.emplace_back(box.u0 + 0.5 * (UV(v, 0) + 1) * (box.u1 - box.u0),
                       box.v0 + 0.5 * (UV(v, 1) + 1) * (box.v1 - box.v0));
    for (std::size_t f = 0; f < graph.faces.size(); ++f)
      for (int v : graph.corners[f]) mesh.face_uvs[graph.faces[f]].push_back(first + v);
  }
  mesh.UV.resize(static_cast<Eigen::Index>(all.size()), 2);
  for (std::size_t k = 0; k < all.size(); ++k) mesh.UV.row(static_cast<Eigen::Index>(k)) = all[k].transpose();
}

}  // namespace phiz
