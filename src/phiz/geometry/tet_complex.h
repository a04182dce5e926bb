// SPDX-License-Identifier: GPL-3.0-or-later
/// A tet mesh under change: what improve_tets works on.
#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "phiz/geometry/mesh.h"

namespace phiz {

using Corners = std::array<int, 4>;
inline constexpr double infinite = std::numeric_limits<double>::infinity();

/// Smallest sine of the six dihedral angles; negative when inverted, 0 when flat.
double least_sine(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d);
/// The same with its gradient by `a`.
double least_sine(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d, Vector3d& gradient);

/// The quality that is improved: least_sine, or the volume-length measure (1 for a regular tet) times `weight` where
/// that is less. The second tells of splinters, which are thin but have fair angles.
double tet_shape(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d, double weight);
/// The same with its gradient by `a`.
double tet_shape(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d, double weight,
                 Vector3d& gradient);
inline constexpr double angles_only = std::numeric_limits<double>::infinity();

/// Tets that can be exchanged for others, with the way back. A surface is what bounds the mesh or parts two regions.
class TetComplex {
 public:
  struct Tet {
    Corners v;
    int region;
    double quality;  ///< tet_shape
    bool alive;
  };

  /// `give`: how far each vertex may move when it lies on a surface, or empty.
  TetComplex(const TetMesh& mesh, const VectorXd& give);

  int vertices() const { return static_cast<int>(x_.size()); }
  int tets() const { return static_cast<int>(tets_.size()); }
  const Vector3d& x(int v) const { return x_[static_cast<std::size_t>(v)]; }
  const Tet& tet(int t) const { return tets_[static_cast<std::size_t>(t)]; }
  const std::vector<int>& tets_of(int v) const { return tets_of_[static_cast<std::size_t>(v)]; }
  bool on_surface(int v) const { return on_surface_[static_cast<std::size_t>(v)] != 0; }
  bool may_move(int v) const { return !on_surface(v) || give_[static_cast<std::size_t>(v)] > 0; }
  /// The place nearest to p where the vertex may be.
  Vector3d allowed(int v, const Vector3d& p) const;
  double moved_by(int v) const { return (x(v) - home_[static_cast<std::size_t>(v)]).norm(); }

  /// The tet across the face opposite to corner k when it belongs to the same region, else -1.
  int across(int t, int k) const;
  /// Tets with both vertices, in the order of tets_of(a).
  std::vector<int> tets_of_edge(int a, int b) const;
  double quality(const Corners& v) const;
  double weight() const { return weight_; }
  /// Another weight of tet_shape from here on; angles_only at first.
  void measure_with(double weight);
  double worst(std::span<const int> tets) const;

  void move(int v, const Vector3d& to);
  int add_vertex(const Vector3d& at);
  void exchange(std::span<const int> old, std::span<const Corners> fresh);

  /// Changes since a mark can be taken back.
  std::size_t mark() const { return journal_.size(); }
  void take_back(std::size_t mark);
  /// Whether the worst of the tets changed since the mark became better.
  bool is_better_since(std::size_t mark, double by) const;
  /// Forgets the way back.
  void settle() { journal_.clear(); }

  TetMesh mesh() const;

 private:
  struct Entry {
    int tet;     ///< changed or new tet, or -1
    Tet before;  ///< not alive: the tet was new
    int vertex;  ///< moved vertex, or -1
    Vector3d place;
  };
  void link(int t);
  void unlink(int t);

  double weight_ = angles_only;
  std::vector<Vector3d> x_, home_;
  std::vector<double> give_;
  std::vector<char> on_surface_;
  std::vector<Tet> tets_;
  std::vector<std::vector<int>> tets_of_;
  std::vector<Entry> journal_;
};

/// The corner of tet v that is the vertex, or -1.
inline int corner_of(const Corners& v, int vertex) {
  for (int k = 0; k < 4; ++k)
    if (v[static_cast<std::size_t>(k)] == vertex) return k;
  return -1;
}

/// Outward faces: corners of the face opposite to each corner.
inline constexpr int face_corners[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

}  // namespace phiz
