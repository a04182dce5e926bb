// SPDX-License-Identifier: GPL-3.0-or-later
/// The fixed connectivity of the skin cage: one sheet of quads round the head with rings of quads round mouth, eyes,
/// nostrils and ears, each closed inwards, so that the whole is one closed surface. The same for every person.
///
/// The left half (x >= 0) is laid out on integer coordinates, the right half mirrors it.
///
///   sheet(i, j)       i: 0 front midline .. 6 nasolabial fold .. 10 outer eye .. 12 before the ear .. 18 back midline;
///                     j: 0 foot of the neck .. 5 jaw line .. 7 under the lip .. 11 under the nose .. 18 under the eye
///                     .. 22 brow
///                     .. 26 round the crown. Behind the ear (i >= 14) rows 12 and 13 are followed by row 20.
///   mouth(ring, c)    ring 0 on the sheet .. 3 vermilion border .. 5 front of the parting .. 6 its back .. 8 gum folds
///   .. 11 throat;
///                     c: 0 upper midline .. 8 corner .. 16 lower midline
///   eye(ring, c)      ring 0 on the sheet .. 3 crease .. 5 outer edge of the lid margin, 6 its inner edge .. 9 behind
///   the
///                     eyeball; c: 0 inner canthus, 1..7 upper lid, 8 outer canthus, 9..15 lower lid
///   nostril(ring, c)  ring 0 the rim .. 3 deep inside; c: 0 behind the columella, 1, 2 front .. 4 .. 6 outer back, 7
///                     sill
///   ear(ring, c)      ring 0 on the head, 1, 2 back of the auricle, 3 rim of the helix, 4 its front edge, 5 scapha,
///                     6 antihelix .. 8 floor of the concha; c: 0 below the lobe's front, 3 tragus, 8 top, 11 back,
///                     15 lobe
///   foot_rim(i)       inside the cut of the neck, along sheet(i, 0)
///   crown, foot, throat (u, v), socket, nostril_end, concha (u, v): the grids that close the holes
#pragma once

#include <array>
#include <vector>

namespace phiz {

/// Which part of the surface a face lies on; each island of the texture map is one of them.
enum class SkinIsland : int {
  outside,
  mouth,
  left_socket,
  right_socket,
  left_nostril,
  right_nostril,
  left_ear,
  right_ear,
  foot
};

class SkinTopology {
 public:
  static constexpr int columns = 18, rows = 26, mouth_rings = 11, eye_rings = 9, nostril_rings = 3, ear_rings = 8;
  static constexpr int mouth_columns = 16, eye_columns = 16, nostril_columns = 8, ear_columns = 16;
  static constexpr int crown_columns = 4, crown_rows = columns - 2 * crown_columns;
  static constexpr int foot_columns = 6, foot_rows = columns - 2 * foot_columns;

  SkinTopology();

  int sheet(int i, int j) const { return sheet_[i][j]; }  ///< -1 inside holes
  int mouth(int ring, int c) const { return mouth_[ring][c]; }
  int eye(int ring, int c) const { return eye_[ring][(c + eye_columns) % eye_columns]; }
  int nostril(int ring, int c) const { return nostril_[ring][(c + nostril_columns) % nostril_columns]; }
  int ear(int ring, int c) const { return ear_[ring][(c + ear_columns) % ear_columns]; }
  int crown(int u, int v) const { return crown_[u][v]; }  ///< u: 0 midline .. 4, v: 0 front .. 10 back
  int foot_rim(int i) const { return foot_rim_[i]; }
  int foot(int u, int v) const { return foot_[u][v]; }      ///< u: 0 midline .. 6, v: 0 front .. 6 back; rim: foot_rim
  int throat(int u, int v) const { return throat_[u][v]; }  ///< u: 0 midline .. 7, v: 0 upper .. 2 lower
  int socket(int u, int v) const { return socket_[u][v]; }  ///< 0..4 x 0..4 behind the eyeball, u outwards, v up
  int nostril_end() const { return nostril_end_; }
  int concha(int u, int v) const { return concha_[u][v]; }  ///< 0..4 x 0..4 bottom of the concha

  int vertex_count() const { return static_cast<int>(mirror_.size()); }
  int left_count() const { return left_count_; }  ///< vertices 0..left_count-1 have x >= 0
  bool on_midline(int v) const { return mirror_[v] == v; }
  int mirror(int v) const { return mirror_[v]; }                           ///< the vertex on the other side
  const std::vector<std::array<int, 4>>& faces() const { return faces_; }  ///< counter-clockwise seen from outside
  const std::vector<SkinIsland>& islands() const { return islands_; }      ///< per face

 private:
  using Grid = std::vector<std::vector<int>>;
  int add(bool midline);
  void add_face(int a, int b, int c, int d, SkinIsland island);
  void add_rings(Grid& rings, const std::vector<int>& rim, int count, bool closed, int outer_rings, SkinIsland outer,
                 SkinIsland inner);
  Grid close_half(const std::vector<int>& arc, int p, bool clockwise, SkinIsland island);
  Grid close_ring(const std::vector<int>& ring, int n, int first_u, int first_v, SkinIsland island);
  void mirror_right();

  Grid sheet_, mouth_, eye_, nostril_, ear_, crown_, foot_, throat_, socket_, concha_;
  std::vector<int> foot_rim_;
  int nostril_end_ = -1;
  int left_count_ = 0;
  std::vector<char> midline_;
  std::vector<int> mirror_;
  std::vector<std::array<int, 4>> faces_;
  std::vector<SkinIsland> islands_;
};

/// The one connectivity of all skins.
const SkinTopology& skin_topology();

}  // namespace phiz
