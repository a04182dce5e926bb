// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/geometry/coarsen.h"

#include <CGAL/boost/graph/Euler_operations.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "phiz/core/parallel.h"
#include "phiz/geometry/cgal_mesh.h"
#include "phiz/geometry/spatial_query.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/validate.h"

namespace phiz {

namespace {

using Vertex = CgalMesh::Vertex_index;
using Halfedge = CgalMesh::Halfedge_index;
using Edge = CgalMesh::Edge_index;

constexpr double collapse_below = 0.78;  // of the wanted length
constexpr double longest = 1.45;         // of the wanted length, after a collapse
constexpr double least_turn = 0.5;       // cosine between the normals of a triangle before and after a change
constexpr double form_tolerance = 0.12;  // of the wanted length: how far a collapse may move the surface
constexpr double sharp = 0.6;            // cosine between the normals of a vertex and of a triangle at a sharp edge
constexpr double flat_enough = 0.85;     // cosine across an edge that may be flipped

class Coarsener {
 public:
  Coarsener(const TriangleMesh& fine, const CoarsenOptions& options)
      : options_(options),
        fine_(fine),
        normals_(triangle_normals(fine.V, fine.F)),
        query_(fine),
        mesh_(to_cgal(fine, "coarsen")) {}

  TriangleMesh run() {
    if (options_.slenderness > 0) measure_thickness();
    for (int round = 0; round < options_.rounds; ++round) {
      measure();
      collapse();
      flip();
      relax();
    }
    flip();
    return from_cgal(mesh_);
  }

 private:
  Vector3d at(Vertex v) const {
    const auto& p = mesh_.point(v);
    return {p.x(), p.y(), p.z()};
  }
  static Vector3d normal(const Vector3d& a, const Vector3d& b, const Vector3d& c) { return (b - a).cross(c - a); }

  /// Smallest angle of a triangle as its sine times two thirds; 0 when flat.
  static double shape(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    const double sum = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
    return sum > 0 ? 2 * std::sqrt(3.0) * normal(a, b, c).norm() / sum : 0;
  }

  /// How far it is through the body, per fine vertex; the least of a vertex and its neighbours.
  void measure_thickness() {
    constexpr double lift = 1e-5, farthest = 0.1;
    const MatrixX3d inward = -vertex_normals(fine_.V, fine_.F);
    VectorXd through(fine_.V.rows());
    parallel_for(
        through.size(),
        [&](std::ptrdiff_t v) {
          const auto hit = query_.first_hit(fine_.V.row(v) + lift * inward.row(v), inward.row(v), 0, farthest);
          through[v] = hit ? hit->t : farthest;
        },
        64);
    thickness_ = through;
    for (Eigen::Index f = 0; f < fine_.F.rows(); ++f) {
      const double least = std::min({through[fine_.F(f, 0)], through[fine_.F(f, 1)], through[fine_.F(f, 2)]});
      for (int k = 0; k < 3; ++k) thickness_[fine_.F(f, k)] = std::min(thickness_[fine_.F(f, k)], least);
    }
  }

  double wanted_at(const Vector3d& p) const {
    const double length = options_.edge_length(p);
    if (thickness_.size() == 0) return length;
    const SurfacePoint near = query_.closest_point(p);
    double thickness = 0;
    for (int k = 0; k < 3; ++k) thickness += near.barycentric[k] * thickness_[fine_.F(near.triangle, k)];
    return std::min(length, options_.slenderness * thickness);
  }

  void measure() {
    wanted_.assign(mesh_.num_vertices(), 0);
    for (const Vertex v : mesh_.vertices()) wanted_[v] = wanted_at(at(v));
  }

  double relative_length(Vertex a, Vertex b) const {
    return (at(a) - at(b)).norm() / (0.5 * (wanted_[a] + wanted_[b]));
  }

  /// Whether the triangles round `v` (without those that hold `gone`) keep their side and shape with v at p.
  bool fits(Vertex v, Vertex gone, Vertex kept, const Vector3d& p) const {
    for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
      const Vertex a = mesh_.source(h), b = mesh_.target(mesh_.next(h));
      if (a == gone || b == gone) continue;
      const Vector3d before = normal(at(a), at(v), at(b)), after = normal(at(a), p, at(b));
      if (after.dot(before) < least_turn * after.norm() * before.norm()) return false;
      if (shape(at(a), p, at(b)) < std::min(0.25, 0.6 * shape(at(a), at(v), at(b)))) return false;
      if (gone != kept && (p - at(a)).norm() > longest * 0.5 * (wanted_[v] + wanted_[a])) return false;
    }
    return true;
  }

  /// Whether the fan of triangles that a and b leave behind, with its apex at p, passes near both.
  bool keeps_form(Vertex a, Vertex b, const Vector3d& p) const {
    double off_a = 1e9, off_b = 1e9;
    for (const auto& [v, gone] : {std::pair(a, b), std::pair(b, a)}) {
      for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
        const Vertex c = mesh_.source(h), d = mesh_.target(mesh_.next(h));
        if (c == gone || d == gone) continue;
        const auto distance = [&](const Vector3d& q) {
          const Vector3d w = closest_barycentric(q, at(c), p, at(d));
          return (w[0] * at(c) + w[1] * p + w[2] * at(d) - q).norm();
        };
        off_a = std::min(off_a, distance(at(a)));
        off_b = std::min(off_b, distance(at(b)));
      }
    }
    return std::max(off_a, off_b) < form_tolerance * 0.5 * (wanted_[a] + wanted_[b]);
  }

  /// The point of the fine surface near p that faces along `direction`, or nothing.
  bool project(Vector3d& p, const Vector3d& direction, double reach) const {
    const auto near = query_.closest_point_within(p, reach);
    if (!near || normals_.row(near->triangle).dot(direction) < 0.3 * direction.norm()) return false;
    p = near->position;
    return true;
  }

  Vector3d vertex_normal(Vertex v) const {
    Vector3d sum = Vector3d::Zero();
    for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v)))
      sum += normal(at(mesh_.source(h)), at(v), at(mesh_.target(mesh_.next(h))));
    return sum;
  }

  /// Vertices of sharp edges stay where they are.
  bool is_sharp(Vertex v, const Vector3d& n) const {
    for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
      const Vector3d m = normal(at(mesh_.source(h)), at(v), at(mesh_.target(mesh_.next(h))));
      if (m.dot(n) < sharp * m.norm()) return true;
    }
    return false;
  }

  void collapse() {
    std::vector<std::pair<double, Edge>> order;
    for (const Edge e : mesh_.edges()) {
      const double length = relative_length(mesh_.vertex(e, 0), mesh_.vertex(e, 1));
      if (length < collapse_below) order.emplace_back(length, e);
    }
    std::sort(order.begin(), order.end());
    for (const auto& [unused, e] : order) {
      if (mesh_.is_removed(e)) continue;
      const Halfedge h = mesh_.halfedge(e);
      const Vertex a = mesh_.source(h), b = mesh_.target(h);
      if (relative_length(a, b) >= collapse_below || !CGAL::Euler::does_satisfy_link_condition(e, mesh_)) continue;
      if (mesh_.degree(a) + mesh_.degree(b) > 13) continue;
      Vector3d p = 0.5 * (at(a) + at(b));
      if (!project(p, vertex_normal(a) + vertex_normal(b), (at(a) - at(b)).norm())) continue;
      if (!fits(a, b, a, p) || !fits(b, a, b, p) || !keeps_form(a, b, p)) continue;
      const double size = wanted_at(p);
      const Vertex left = CGAL::Euler::collapse_edge(e, mesh_);
      mesh_.point(left) = {p.x(), p.y(), p.z()};
      wanted_[left] = size;
    }
  }

  void flip() {
    for (int pass = 0; pass < 2; ++pass) {
      for (const Edge e : mesh_.edges()) {
        const Halfedge h = mesh_.halfedge(e), o = mesh_.opposite(h);
        const Vertex a = mesh_.source(h), b = mesh_.target(h);
        const Vertex c = mesh_.target(mesh_.next(h)), d = mesh_.target(mesh_.next(o));
        if (mesh_.degree(a) <= 3 || mesh_.degree(b) <= 3 || mesh_.halfedge(c, d) != CgalMesh::null_halfedge()) continue;
        const Vector3d A = at(a), B = at(b), C = at(c), D = at(d);
        const double now = std::min(shape(A, B, C), shape(B, A, D)), then = std::min(shape(A, D, C), shape(D, B, C));
        if (then <= now + 0.02) continue;
        const Vector3d n1 = normal(A, B, C).normalized(), n2 = normal(B, A, D).normalized();
        const Vector3d m1 = normal(A, D, C).normalized(), m2 = normal(D, B, C).normalized();
        if (n1.dot(n2) < flat_enough && now > 0.1) continue;
        if (m1.dot(m2) < std::min(flat_enough, n1.dot(n2)) || m1.dot(n1 + n2) <= 0 || m2.dot(n1 + n2) <= 0) continue;
        CGAL::Euler::flip_edge(h, mesh_);
      }
    }
  }

  void relax() {
    for (int pass = 0; pass < 3; ++pass) {
      for (const Vertex v : mesh_.vertices()) {
        const Vector3d n = vertex_normal(v).normalized(), p = at(v);
        Vector3d mean = Vector3d::Zero();
        double weights = 0;
        for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
          const Vector3d a = at(mesh_.source(h)), b = at(mesh_.target(mesh_.next(h)));
          const double size = (wanted_[v] + wanted_[mesh_.source(h)] + wanted_[mesh_.target(mesh_.next(h))]) / 3;
          const double weight = normal(a, p, b).norm() / (size * size);
          mean += weight * (a + b + p) / 3;
          weights += weight;
        }
        Vector3d q = mean / weights;
        q = p + 0.6 * ((q - p) - n * n.dot(q - p));
        if (!project(q, n, 0.5 * wanted_[v]) || !fits(v, v, v, q) || is_sharp(v, n)) continue;
        mesh_.point(v) = {q.x(), q.y(), q.z()};
      }
    }
  }

  const CoarsenOptions& options_;
  const TriangleMesh& fine_;
  MatrixX3d normals_;
  SurfaceQuery query_;
  CgalMesh mesh_;
  VectorXd thickness_;
  std::vector<double> wanted_;  // edge length per vertex
};

}  // namespace

TriangleMesh coarsen(const TriangleMesh& fine, const CoarsenOptions& options) {
  require_closed_manifold(fine, "coarsen");
  return Coarsener({fine.V, fine.F, {}, {}}, options).run();
}

}  // namespace phiz
