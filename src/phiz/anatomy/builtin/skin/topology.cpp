// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/skin/topology.h"

namespace phiz {
namespace {

SkinIsland right_of(SkinIsland island) {
  switch (island) {
    case SkinIsland::left_socket:
      return SkinIsland::right_socket;
    case SkinIsland::left_nostril:
      return SkinIsland::right_nostril;
    case SkinIsland::left_ear:
      return SkinIsland::right_ear;
    default:
      return island;
  }
}

/// Is sheet(i, j) absent: inside a hole, or one of the rows that end at the ear?
bool in_hole(int i, int j) {
  const bool mouth = i < 6 && j > 7 && j < 11;
  const bool eye = i > 6 && i < 10 && j > 18 && j < 22;
  const bool nostril = i == 2 && j == 13;
  const bool ear = i == 13 && j > 11 && j < 20;
  const bool behind_ear = i > 13 && j > 13 && j < 20;
  return mouth || eye || nostril || ear || behind_ear;
}

/// The row after j in column i, going up.
int row_above(int i, int j) {
  return i > 13 && j == 13 ? 20 : j + 1;
}

/// The perimeter of the square grid 0..n x 0..n, clockwise (u right, v up) from (first_u, first_v).
std::vector<std::array<int, 2>> perimeter(int n, int first_u, int first_v) {
  std::vector<std::array<int, 2>> path;
  std::array<int, 2> at{first_u, first_v};
  do {
    path.push_back(at);
    auto& [u, v] = at;
    if (u == 0 && v < n)
      ++v;
    else if (v == n && u < n)
      ++u;
    else if (u == n && v > 0)
      --v;
    else
      --u;
  } while (at[0] != first_u || at[1] != first_v);
  return path;
}

}  // namespace

int SkinTopology::add(bool midline) {
  midline_.push_back(midline);
  return static_cast<int>(midline_.size()) - 1;
}

void SkinTopology::add_face(int a, int b, int c, int d, SkinIsland island) {
  faces_.push_back({a, b, c, d});
  islands_.push_back(island);
}

/// Rings inside the clockwise rim; faces between the first `outer_rings` pairs belong to `outer`. An open rim starts
/// and ends on the midline.
void SkinTopology::add_rings(Grid& rings, const std::vector<int>& rim, int count, bool closed, int outer_rings,
                             SkinIsland outer, SkinIsland inner) {
  const int n = static_cast<int>(rim.size());
  rings.assign(count + 1, std::vector<int>(n));
  rings[0] = rim;
  for (int r = 1; r <= count; ++r)
    for (int c = 0; c < n; ++c) rings[r][c] = add(!closed && (c == 0 || c == n - 1));
  for (int r = 0; r < count; ++r)
    for (int c = 0; c < (closed ? n : n - 1); ++c) {
      const int next = (c + 1) % n;
      add_face(rings[r][c], rings[r + 1][c], rings[r + 1][next], rings[r][next], r < outer_rings ? outer : inner);
    }
}

/// Closes a half disc between an arc (both ends on the midline) and the midline by a grid of p columns.
SkinTopology::Grid SkinTopology::close_half(const std::vector<int>& arc, int p, bool clockwise, SkinIsland island) {
  const int n = static_cast<int>(arc.size()) - 1, q = n - 2 * p;
  Grid grid(p + 1, std::vector<int>(q + 1));
  for (int u = 0; u <= p; ++u)
    for (int v = 0; v <= q; ++v) {
      if (v == 0)
        grid[u][v] = arc[u];
      else if (v == q)
        grid[u][v] = arc[n - u];
      else if (u == p)
        grid[u][v] = arc[p + v];
      else
        grid[u][v] = add(u == 0);
    }
  for (int u = 0; u < p; ++u)
    for (int v = 0; v < q; ++v) {
      if (clockwise)
        add_face(grid[u][v], grid[u][v + 1], grid[u + 1][v + 1], grid[u + 1][v], island);
      else
        add_face(grid[u][v], grid[u + 1][v], grid[u + 1][v + 1], grid[u][v + 1], island);
    }
  return grid;
}

/// Closes a clockwise ring of 4 n vertices by an n x n grid whose corner (first_u, first_v) is ring[0].
SkinTopology::Grid SkinTopology::close_ring(const std::vector<int>& ring, int n, int first_u, int first_v,
                                            SkinIsland island) {
  Grid grid(n + 1, std::vector<int>(n + 1, -1));
  const auto path = perimeter(n, first_u, first_v);
  for (std::size_t c = 0; c < ring.size(); ++c) grid[path[c][0]][path[c][1]] = ring[c];
  for (int u = 1; u < n; ++u)
    for (int v = 1; v < n; ++v) grid[u][v] = add(false);
  for (int u = 0; u < n; ++u)
    for (int v = 0; v < n; ++v) add_face(grid[u][v], grid[u + 1][v], grid[u + 1][v + 1], grid[u][v + 1], island);
  return grid;
}

SkinTopology::SkinTopology() {
  sheet_.assign(columns + 1, std::vector<int>(rows + 1, -1));
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i)
      if (!in_hole(i, j)) sheet_[i][j] = add(i == 0 || i == columns);
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const bool mouth = i < 6 && j >= 7 && j < 11;
      const bool eye = i >= 6 && i < 10 && j >= 18 && j < 22;
      const bool nostril = i >= 1 && i < 3 && j >= 12 && j < 14;
      const bool ear = i >= 12 && i < 14 && j >= 11 && j < 20;
      if (mouth || eye || nostril || ear || sheet_[i][j] < 0 || sheet_[i + 1][j] < 0) continue;
      const int up = row_above(i + 1, j);
      add_face(sheet_[i][j], sheet_[i + 1][j], sheet_[i + 1][up], sheet_[i][i > 13 ? up : j + 1], SkinIsland::outside);
    }

  std::vector<int> mouth_rim, eye_rim, nostril_rim, ear_rim;
  for (int i = 0; i <= 6; ++i) mouth_rim.push_back(sheet_[i][11]);
  for (int j = 10; j >= 7; --j) mouth_rim.push_back(sheet_[6][j]);
  for (int i = 5; i >= 0; --i) mouth_rim.push_back(sheet_[i][7]);
  add_rings(mouth_, mouth_rim, mouth_rings, false, 6, SkinIsland::outside, SkinIsland::mouth);

  for (const auto& [u, v] : perimeter(4, 0, 2)) eye_rim.push_back(sheet_[6 + u][18 + v]);
  add_rings(eye_, eye_rim, eye_rings, true, 5, SkinIsland::outside, SkinIsland::left_socket);

  for (const auto& [u, v] : perimeter(2, 0, 0)) nostril_rim.push_back(sheet_[1 + u][12 + v]);
  add_rings(nostril_, nostril_rim, nostril_rings, true, 0, SkinIsland::outside, SkinIsland::left_nostril);

  for (int j = 11; j <= 20; ++j) ear_rim.push_back(sheet_[12][j]);
  ear_rim.push_back(sheet_[13][20]);
  for (int j : {20, 13, 12, 11}) ear_rim.push_back(sheet_[14][j]);
  ear_rim.push_back(sheet_[13][11]);
  add_rings(ear_, ear_rim, ear_rings, true, 0, SkinIsland::outside, SkinIsland::left_ear);

  std::vector<int> crown_arc, foot_arc;
  for (int i = 0; i <= columns; ++i) {
    crown_arc.push_back(sheet_[i][rows]);
    foot_arc.push_back(sheet_[i][0]);
  }
  crown_ = close_half(crown_arc, crown_columns, false, SkinIsland::outside);
  for (int i = 0; i <= columns; ++i) foot_rim_.push_back(add(i == 0 || i == columns));
  for (int i = 0; i < columns; ++i)
    add_face(foot_arc[i], foot_rim_[i], foot_rim_[i + 1], foot_arc[i + 1], SkinIsland::foot);
  foot_ = close_half(foot_rim_, foot_columns, true, SkinIsland::foot);
  throat_ = close_half(mouth_[mouth_rings], 7, true, SkinIsland::mouth);
  socket_ = close_ring(eye_[eye_rings], 4, 0, 2, SkinIsland::left_socket);
  nostril_end_ = close_ring(nostril_[nostril_rings], 2, 0, 0, SkinIsland::left_nostril)[1][1];
  concha_ = close_ring(ear_[ear_rings], 4, 0, 0, SkinIsland::left_ear);
  mirror_right();
}

void SkinTopology::mirror_right() {
  left_count_ = static_cast<int>(midline_.size());
  mirror_.assign(left_count_, -1);
  for (int v = 0; v < left_count_; ++v) {
    if (midline_[v]) {
      mirror_[v] = v;
    } else {
      mirror_[v] = static_cast<int>(mirror_.size());
      mirror_.push_back(v);
    }
  }
  const std::size_t left_faces = faces_.size();
  for (std::size_t f = 0; f < left_faces; ++f) {
    const auto [a, b, c, d] = faces_[f];
    add_face(mirror_[a], mirror_[d], mirror_[c], mirror_[b], right_of(islands_[f]));
  }
}

const SkinTopology& skin_topology() {
  static const SkinTopology topology;
  return topology;
}

}  // namespace phiz
