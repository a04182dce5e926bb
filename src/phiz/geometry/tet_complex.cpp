// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/geometry/tet_complex.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "phiz/geometry/topology.h"

namespace phiz {

namespace {

/// Six volumes, edges ij and doubled areas of the faces opposite to k; the sine at edge ij between the faces opposite
/// to k and l is |ij| six_volume / (area_k area_l).
struct Shape {
  Vector3d u, v, w;    ///< b - a, c - a, d - a
  Vector3d normal[4];  ///< of the face opposite to each corner, doubled area long
  double area[4];
  double six_volume;

  Shape(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) : u(b - a), v(c - a), w(d - a) {
    normal[0] = (v - u).cross(w - u);
    normal[1] = w.cross(v);
    normal[2] = u.cross(w);
    normal[3] = v.cross(u);
    for (int k = 0; k < 4; ++k) area[k] = normal[k].norm();
    six_volume = -normal[3].dot(w);
  }
};

struct EdgeCorners {
  int i, j, k, l;
};
constexpr EdgeCorners edge_corners[6] = {{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 3, 1, 2},
                                         {1, 2, 0, 3}, {1, 3, 0, 2}, {2, 3, 0, 1}};

}  // namespace

double least_sine(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  const Shape s(a, b, c, d);
  const Vector3d edge[6] = {s.u, s.v, s.w, s.v - s.u, s.w - s.u, s.w - s.v};
  double smallest = infinite, largest = 0;
  for (int e = 0; e < 6; ++e) {
    const double below = s.area[edge_corners[e].k] * s.area[edge_corners[e].l];
    if (!(below > 0)) return 0;
    const double ratio = edge[e].norm() / below;
    smallest = std::min(smallest, ratio);
    largest = std::max(largest, ratio);
  }
  return s.six_volume * (s.six_volume > 0 ? smallest : largest);
}

double least_sine(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d, Vector3d& gradient) {
  const Shape s(a, b, c, d);
  const Vector3d edge[6] = {s.u, s.v, s.w, s.v - s.u, s.w - s.u, s.w - s.v};
  gradient.setZero();
  double least = infinite;
  int at = -1;
  for (int e = 0; e < 6; ++e) {
    const double below = s.area[edge_corners[e].k] * s.area[edge_corners[e].l];
    if (!(below > 0)) return 0;
    const double sine = edge[e].norm() * s.six_volume / below;
    if (sine < least) {
      least = sine;
      at = e;
    }
  }
  const auto [i, j, k, l] = edge_corners[at];
  const double below = s.area[k] * s.area[l];
  // d(six volume)/da is the inward normal of the face opposite to a.
  gradient = -edge[at].norm() / below * s.normal[0];
  if (i == 0) gradient -= least / edge[at].squaredNorm() * edge[at];
  const Vector3d* corner[4] = {&a, &b, &c, &d};
  for (const int face : {k, l}) {
    if (face == 0) continue;  // does not have a
    const int p = face == 1 ? 2 : 1, q = face == 3 ? 2 : 3;
    const Vector3d normal = (*corner[p] - a).cross(*corner[q] - a);
    gradient -= least / normal.squaredNorm() * (*corner[p] - *corner[q]).cross(normal);
  }
  return least;
}

namespace {

/// 6 sqrt(2) volume / (root mean square edge)^3: 1 regular, 0 flat (Parthasarathy, Graichen and Hathaway 1994).
struct VolumeLength {
  Vector3d around;  ///< sum of the edges from a
  double squared;   ///< mean square edge
  double value;

  explicit VolumeLength(const Shape& s) : around(s.u + s.v + s.w) {
    squared = (s.u.squaredNorm() + s.v.squaredNorm() + s.w.squaredNorm() + (s.v - s.u).squaredNorm() +
               (s.w - s.u).squaredNorm() + (s.w - s.v).squaredNorm()) /
              6;
    value = std::sqrt(2.0) * s.six_volume / (squared * std::sqrt(squared));
  }
  Vector3d gradient(const Shape& s) const {
    return -std::sqrt(2.0) / (squared * std::sqrt(squared)) * s.normal[0] + 0.5 * value / squared * around;
  }
};

}  // namespace

double tet_shape(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d, double weight) {
  const double sine = least_sine(a, b, c, d);
  if (!(sine > 0) || weight == angles_only) return sine;
  return std::min(sine, weight * VolumeLength(Shape(a, b, c, d)).value);
}

double tet_shape(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d, double weight,
                 Vector3d& gradient) {
  const double sine = least_sine(a, b, c, d, gradient);
  if (!(sine > 0) || weight == angles_only) return sine;
  const Shape s(a, b, c, d);
  const VolumeLength measure(s);
  if (sine <= weight * measure.value) return sine;
  gradient = weight * measure.gradient(s);
  return weight * measure.value;
}

TetComplex::TetComplex(const TetMesh& mesh, const VectorXd& give)
    : give_(static_cast<std::size_t>(mesh.V.rows()), 0.0),
      on_surface_(static_cast<std::size_t>(mesh.V.rows()), 0),
      tets_of_(static_cast<std::size_t>(mesh.V.rows())) {
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) x_.emplace_back(mesh.V.row(v));
  home_ = x_;
  const RegionFaces surface = region_faces(mesh);
  for (Eigen::Index f = 0; f < surface.F.rows(); ++f)
    for (int k = 0; k < 3; ++k) on_surface_[static_cast<std::size_t>(surface.F(f, k))] = 1;
  for (Eigen::Index v = 0; v < give.size(); ++v) give_[static_cast<std::size_t>(v)] = give[v];
  for (int t = 0; t < mesh.T.rows(); ++t) {
    const Corners v{mesh.T(t, 0), mesh.T(t, 1), mesh.T(t, 2), mesh.T(t, 3)};
    tets_.push_back({v, mesh.region[t], quality(v), true});
    link(t);
  }
}

Vector3d TetComplex::allowed(int v, const Vector3d& p) const {
  if (!on_surface(v)) return p;
  const Vector3d& home = home_[static_cast<std::size_t>(v)];
  const double give = give_[static_cast<std::size_t>(v)], distance = (p - home).norm();
  return distance > give ? Vector3d(home + give / distance * (p - home)) : p;
}

int TetComplex::across(int t, int k) const {
  const Corners& v = tet(t).v;
  int face[3];
  for (int i = 0; i < 3; ++i) face[i] = v[static_cast<std::size_t>(face_corners[k][i])];
  for (const int other : tets_of(face[0])) {
    if (other == t) continue;
    const Corners& o = tet(other).v;
    if (corner_of(o, face[1]) >= 0 && corner_of(o, face[2]) >= 0)
      return tet(other).region == tet(t).region ? other : -1;
  }
  return -1;
}

std::vector<int> TetComplex::tets_of_edge(int a, int b) const {
  std::vector<int> found;
  for (const int t : tets_of(a))
    if (corner_of(tet(t).v, b) >= 0) found.push_back(t);
  return found;
}

double TetComplex::quality(const Corners& v) const {
  return tet_shape(x(v[0]), x(v[1]), x(v[2]), x(v[3]), weight_);
}

void TetComplex::measure_with(double weight) {
  weight_ = weight;
  settle();
  for (Tet& t : tets_)
    if (t.alive) t.quality = quality(t.v);
}

double TetComplex::worst(std::span<const int> tets) const {
  double q = infinite;
  for (const int t : tets) q = std::min(q, tet(t).quality);
  return q;
}

void TetComplex::link(int t) {
  for (const int v : tet(t).v) tets_of_[static_cast<std::size_t>(v)].push_back(t);
}

void TetComplex::unlink(int t) {
  for (const int v : tet(t).v) {
    auto& list = tets_of_[static_cast<std::size_t>(v)];
    list.erase(std::find(list.begin(), list.end(), t));
  }
}

void TetComplex::move(int v, const Vector3d& to) {
  journal_.push_back({-1, {}, v, x(v)});
  x_[static_cast<std::size_t>(v)] = to;
  for (const int t : tets_of(v)) {
    Tet& changed = tets_[static_cast<std::size_t>(t)];
    journal_.push_back({t, changed, -1, {}});
    changed.quality = quality(changed.v);
  }
}

int TetComplex::add_vertex(const Vector3d& at) {
  x_.push_back(at);
  home_.push_back(at);
  give_.push_back(0);
  on_surface_.push_back(0);
  tets_of_.emplace_back();
  return vertices() - 1;
}

void TetComplex::exchange(std::span<const int> old, std::span<const Corners> fresh) {
  const int region = tet(old[0]).region;
  for (const int t : old) {
    journal_.push_back({t, tet(t), -1, {}});
    unlink(t);
    tets_[static_cast<std::size_t>(t)].alive = false;
    tets_[static_cast<std::size_t>(t)].quality = infinite;
  }
  for (const Corners& v : fresh) {
    tets_.push_back({v, region, quality(v), true});
    const int t = tets() - 1;
    journal_.push_back({t, {v, region, infinite, false}, -1, {}});
    link(t);
  }
}

void TetComplex::take_back(std::size_t mark) {
  while (journal_.size() > mark) {
    const Entry& entry = journal_.back();
    if (entry.tet >= 0) {
      Tet& tet = tets_[static_cast<std::size_t>(entry.tet)];
      if (tet.alive && !entry.before.alive) unlink(entry.tet);
      const bool returns = !tet.alive && entry.before.alive;
      tet = entry.before;
      if (returns) link(entry.tet);
    } else {
      x_[static_cast<std::size_t>(entry.vertex)] = entry.place;
    }
    journal_.pop_back();
  }
}

bool TetComplex::is_better_since(std::size_t mark, double by) const {
  double before = infinite, after = infinite;
  std::unordered_map<int, bool> seen;
  for (std::size_t i = mark; i < journal_.size(); ++i) {
    const Entry& entry = journal_[i];
    if (entry.tet < 0 || !seen.emplace(entry.tet, true).second) continue;
    if (entry.before.alive) before = std::min(before, entry.before.quality);
    if (tet(entry.tet).alive) after = std::min(after, tet(entry.tet).quality);
  }
  return after > before + by;
}

TetMesh TetComplex::mesh() const {
  TetMesh mesh;
  std::vector<int> row(x_.size(), -1);
  int vertex_count = 0, tet_count = 0;
  for (int v = 0; v < vertices(); ++v)
    if (on_surface(v) || !tets_of(v).empty()) row[static_cast<std::size_t>(v)] = vertex_count++;
  for (const Tet& t : tets_) tet_count += t.alive ? 1 : 0;
  mesh.V.resize(vertex_count, 3);
  mesh.T.resize(tet_count, 4);
  mesh.region.resize(tet_count);
  for (int v = 0; v < vertices(); ++v)
    if (row[static_cast<std::size_t>(v)] >= 0) mesh.V.row(row[static_cast<std::size_t>(v)]) = x(v);
  int t = 0;
  for (const Tet& tet : tets_) {
    if (!tet.alive) continue;
    for (int k = 0; k < 4; ++k) mesh.T(t, k) = row[static_cast<std::size_t>(tet.v[static_cast<std::size_t>(k)])];
    mesh.region[t++] = tet.region;
  }
  return mesh;
}

}  // namespace phiz
