// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/geometry/topology.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <tuple>

namespace phiz {

namespace {

/// Outward faces of a positive tet: face k lies opposite to corner k.
constexpr int face_corners[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

struct HalfEdge {
  int low, high, triangle, corner;
  bool forward;  ///< runs from low to high
};

/// Half-edges sorted by their undirected edge, then by triangle.
std::vector<HalfEdge> sorted_half_edges(const MatrixX3i& F) {
  std::vector<HalfEdge> sides;
  sides.reserve(static_cast<std::size_t>(F.rows()) * 3);
  for (int f = 0; f < F.rows(); ++f)
    for (int k = 0; k < 3; ++k) {
      const int a = F(f, k), b = F(f, (k + 1) % 3);
      sides.push_back({std::min(a, b), std::max(a, b), f, k, a < b});
    }
  std::sort(sides.begin(), sides.end(), [](const HalfEdge& l, const HalfEdge& r) {
    return std::tie(l.low, l.high, l.triangle, l.corner) < std::tie(r.low, r.high, r.triangle, r.corner);
  });
  return sides;
}

bool same_edge(const HalfEdge& l, const HalfEdge& r) {
  return l.low == r.low && l.high == r.high;
}

/// Calls visit(first, last) for every run of half-edges on one undirected edge.
template <class Visit>
void for_each_edge(const std::vector<HalfEdge>& sides, Visit&& visit) {
  for (auto first = sides.begin(); first != sides.end();) {
    auto last = first + 1;
    while (last != sides.end() && same_edge(*first, *last)) ++last;
    visit(first, last);
    first = last;
  }
}

class UnionFind {
 public:
  explicit UnionFind(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  int root(int i) {
    while (parent_[static_cast<std::size_t>(i)] != i) {
      int& p = parent_[static_cast<std::size_t>(i)];
      p = parent_[static_cast<std::size_t>(p)];
      i = p;
    }
    return i;
  }
  void join(int a, int b) {
    a = root(a);
    b = root(b);
    parent_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }

 private:
  std::vector<int> parent_;
};

/// Numbers from 0 in order of first appearance of the root of label_of(i).
template <class LabelOf>
VectorXi number_components(Eigen::Index count, LabelOf&& label_of) {
  std::map<int, int> number;
  VectorXi result(count);
  for (Eigen::Index i = 0; i < count; ++i)
    result[i] = number.emplace(label_of(i), static_cast<int>(number.size())).first->second;
  return result;
}

MatrixX2i to_matrix(std::vector<std::pair<int, int>> pairs) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  MatrixX2i result(static_cast<Eigen::Index>(pairs.size()), 2);
  for (std::size_t i = 0; i < pairs.size(); ++i)
    result.row(static_cast<Eigen::Index>(i)) << pairs[i].first, pairs[i].second;
  return result;
}

}  // namespace

bool is_closed(const MatrixX3i& F) {
  bool closed = true;
  for_each_edge(sorted_half_edges(F), [&](auto first, auto last) { closed = closed && last - first >= 2; });
  return closed;
}

bool is_edge_manifold(const MatrixX3i& F) {
  bool manifold = true;
  for_each_edge(sorted_half_edges(F), [&](auto first, auto last) { manifold = manifold && last - first <= 2; });
  return manifold;
}

bool is_oriented(const MatrixX3i& F) {
  bool oriented = true;
  for_each_edge(sorted_half_edges(F), [&](auto first, auto last) {
    const auto forward = std::count_if(first, last, [](const HalfEdge& side) { return side.forward; });
    const auto backward = (last - first) - forward;
    oriented = oriented && (last - first == 1 || forward == backward);
  });
  return oriented;
}

bool is_vertex_manifold(const MatrixX3i& F) {
  if (F.rows() == 0) return true;
  // Corners of triangles that share an edge at a vertex belong to one fan; a manifold vertex has one fan.
  UnionFind fans(static_cast<std::size_t>(F.rows()) * 3);
  const auto corner_at = [&F](int f, int vertex) {
    for (int k = 0; k < 3; ++k)
      if (F(f, k) == vertex) return 3 * f + k;
    return 3 * f;
  };
  for_each_edge(sorted_half_edges(F), [&](auto first, auto last) {
    for (auto other = first + 1; other != last; ++other)
      for (const int vertex : {first->low, first->high})
        fans.join(corner_at(first->triangle, vertex), corner_at(other->triangle, vertex));
  });
  std::vector<int> fan_of(static_cast<std::size_t>(F.maxCoeff()) + 1, -1);
  for (int f = 0; f < F.rows(); ++f)
    for (int k = 0; k < 3; ++k) {
      int& fan = fan_of[static_cast<std::size_t>(F(f, k))];
      const int root = fans.root(3 * f + k);
      if (fan >= 0 && fan != root) return false;
      fan = root;
    }
  return true;
}

MatrixX2i edges(const MatrixX3i& F) {
  std::vector<std::pair<int, int>> pairs;
  for (Eigen::Index f = 0; f < F.rows(); ++f)
    for (int k = 0; k < 3; ++k) pairs.push_back(std::minmax({F(f, k), F(f, (k + 1) % 3)}));
  return to_matrix(std::move(pairs));
}

MatrixX2i tet_edges(const MatrixX4i& T) {
  std::vector<std::pair<int, int>> pairs;
  for (Eigen::Index t = 0; t < T.rows(); ++t)
    for (int a = 0; a < 4; ++a)
      for (int b = a + 1; b < 4; ++b) pairs.push_back(std::minmax({T(t, a), T(t, b)}));
  return to_matrix(std::move(pairs));
}

std::vector<std::vector<int>> boundary_loops(const MatrixX3i& F) {
  std::map<int, std::vector<int>> next;  // boundary edges by their start, ends in descending order
  for_each_edge(sorted_half_edges(F), [&](auto first, auto last) {
    if (last - first == 1)
      next[first->forward ? first->low : first->high].push_back(first->forward ? first->high : first->low);
  });
  for (auto& [start, ends] : next) std::sort(ends.rbegin(), ends.rend());

  std::vector<std::vector<int>> loops;
  while (!next.empty()) {
    std::vector<int> path{next.begin()->first};
    std::map<int, std::size_t> place{{path[0], 0}};
    while (!path.empty()) {
      const auto it = next.find(path.back());
      if (it == next.end()) break;  // an open chain: only in surfaces that are not consistently oriented
      const int end = it->second.back();
      it->second.pop_back();
      if (it->second.empty()) next.erase(it);
      const auto seen = place.find(end);
      if (seen == place.end()) {
        place.emplace(end, path.size());
        path.push_back(end);
        continue;
      }
      std::vector<int> loop(path.begin() + static_cast<std::ptrdiff_t>(seen->second), path.end());
      for (std::size_t i = seen->second + 1; i < path.size(); ++i) place.erase(path[i]);
      path.resize(seen->second + 1);
      std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
      loops.push_back(std::move(loop));
      if (path.size() == 1 && next.find(path[0]) == next.end()) path.clear();
    }
  }
  std::sort(loops.begin(), loops.end());
  return loops;
}

VectorXi triangle_components(const MatrixX3i& F) {
  if (F.rows() == 0) return {};
  UnionFind joined(static_cast<std::size_t>(F.maxCoeff()) + 1);
  for (Eigen::Index f = 0; f < F.rows(); ++f) {
    joined.join(F(f, 0), F(f, 1));
    joined.join(F(f, 0), F(f, 2));
  }
  return number_components(F.rows(), [&](Eigen::Index f) { return joined.root(F(f, 0)); });
}

MatrixX4i tet_neighbours(const MatrixX4i& T) {
  struct Side {
    std::array<int, 3> key;
    int tet, corner;
  };
  std::vector<Side> sides;
  sides.reserve(static_cast<std::size_t>(T.rows()) * 4);
  for (int t = 0; t < T.rows(); ++t)
    for (int k = 0; k < 4; ++k) {
      std::array<int, 3> key{T(t, face_corners[k][0]), T(t, face_corners[k][1]), T(t, face_corners[k][2])};
      std::sort(key.begin(), key.end());
      sides.push_back({key, t, k});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& l, const Side& r) {
    return std::tie(l.key, l.tet, l.corner) < std::tie(r.key, r.tet, r.corner);
  });
  MatrixX4i neighbours = MatrixX4i::Constant(T.rows(), 4, -1);
  for (std::size_t i = 0; i + 1 < sides.size(); ++i)
    if (sides[i].key == sides[i + 1].key) {
      neighbours(sides[i].tet, sides[i].corner) = sides[i + 1].tet;
      neighbours(sides[i + 1].tet, sides[i + 1].corner) = sides[i].tet;
    }
  return neighbours;
}

VectorXi tet_components(const MatrixX4i& T) {
  UnionFind joined(static_cast<std::size_t>(T.rows()));
  const MatrixX4i neighbours = tet_neighbours(T);
  for (int t = 0; t < T.rows(); ++t)
    for (int k = 0; k < 4; ++k)
      if (neighbours(t, k) >= 0) joined.join(t, neighbours(t, k));
  return number_components(T.rows(), [&](Eigen::Index t) { return joined.root(static_cast<int>(t)); });
}

MatrixX3i triangle_neighbours(const MatrixX3i& F) {
  MatrixX3i neighbours = MatrixX3i::Constant(F.rows(), 3, -1);
  for_each_edge(sorted_half_edges(F), [&](auto first, auto last) {
    if (last - first < 2) return;
    const auto second = first + 1;
    neighbours(first->triangle, first->corner) = second->triangle;
    neighbours(second->triangle, second->corner) = first->triangle;
  });
  return neighbours;
}

std::vector<std::vector<int>> vertex_neighbours(const MatrixX3i& F, int vertex_count) {
  std::vector<std::vector<int>> neighbours(static_cast<std::size_t>(vertex_count));
  const MatrixX2i E = edges(F);
  for (Eigen::Index e = 0; e < E.rows(); ++e) {
    neighbours[static_cast<std::size_t>(E(e, 0))].push_back(E(e, 1));
    neighbours[static_cast<std::size_t>(E(e, 1))].push_back(E(e, 0));
  }
  for (auto& list : neighbours) std::sort(list.begin(), list.end());
  return neighbours;
}

namespace {

/// The faces (tet, corner) for which take(tet, neighbour or -1) holds, as outward triangles.
template <class Take>
std::vector<std::pair<int, int>> select_faces(const MatrixX4i& neighbours, Take&& take) {
  std::vector<std::pair<int, int>> faces;
  for (int t = 0; t < neighbours.rows(); ++t)
    for (int k = 0; k < 4; ++k)
      if (take(t, neighbours(t, k))) faces.emplace_back(t, k);
  return faces;
}

MatrixX3i to_triangles(const MatrixX4i& T, const std::vector<std::pair<int, int>>& faces) {
  MatrixX3i F(static_cast<Eigen::Index>(faces.size()), 3);
  for (std::size_t i = 0; i < faces.size(); ++i)
    for (int k = 0; k < 3; ++k)
      F(static_cast<Eigen::Index>(i), k) = T(faces[i].first, face_corners[faces[i].second][k]);
  return F;
}

}  // namespace

MatrixX3i boundary_triangles(const MatrixX4i& T) {
  return to_triangles(T, select_faces(tet_neighbours(T), [](int, int other) { return other < 0; }));
}

RegionFaces region_faces(const TetMesh& mesh) {
  const MatrixX4i neighbours = tet_neighbours(mesh.T);
  const auto faces = select_faces(
      neighbours, [&](int t, int other) { return other < 0 || (t < other && mesh.region[t] != mesh.region[other]); });
  const auto count = static_cast<Eigen::Index>(faces.size());
  RegionFaces result{to_triangles(mesh.T, faces), VectorXi(count), VectorXi(count), VectorXi(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto [t, k] = faces[static_cast<std::size_t>(i)];
    const int other = neighbours(t, k);
    result.tet[i] = t;
    result.inner[i] = mesh.region[t];
    result.outer[i] = other < 0 ? RegionFaces::no_region : mesh.region[other];
  }
  return result;
}

MatrixX3i region_boundary(const TetMesh& mesh, int region) {
  return to_triangles(mesh.T, select_faces(tet_neighbours(mesh.T), [&](int t, int other) {
                        return mesh.region[t] == region && (other < 0 || mesh.region[other] != region);
                      }));
}

CompactMesh remove_unused_vertices(const MatrixX3d& V, const MatrixX3i& F) {
  std::vector<int> row_of(static_cast<std::size_t>(V.rows()), -1);
  for (Eigen::Index f = 0; f < F.rows(); ++f)
    for (int k = 0; k < 3; ++k) row_of[static_cast<std::size_t>(F(f, k))] = 0;
  std::vector<int> kept;
  for (std::size_t v = 0; v < row_of.size(); ++v)
    if (row_of[v] == 0) {
      row_of[v] = static_cast<int>(kept.size());
      kept.push_back(static_cast<int>(v));
    }
  CompactMesh result;
  result.kept = Eigen::Map<const VectorXi>(kept.data(), static_cast<Eigen::Index>(kept.size()));
  result.mesh.V.resize(result.kept.size(), 3);
  for (Eigen::Index i = 0; i < result.kept.size(); ++i) result.mesh.V.row(i) = V.row(result.kept[i]);
  result.mesh.F = F.unaryExpr([&row_of](int v) { return row_of[static_cast<std::size_t>(v)]; });
  return result;
}

}  // namespace phiz
