// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/obstacle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "phiz/core/error.h"
#include "phiz/geometry/topology.h"

namespace phiz {

Obstacle Obstacle::patch(const MatrixX3d& rest, const MatrixX3i& triangles) {
  std::vector<int> vertices(triangles.data(), triangles.data() + triangles.size());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  if (vertices.empty()) reject("contact region", "has no triangles");
  if (vertices.front() < 0 || vertices.back() >= rest.rows())
    reject("contact region", "names a vertex that does not exist");
  MatrixX3d V(static_cast<Eigen::Index>(vertices.size()), 3);
  for (std::size_t i = 0; i < vertices.size(); ++i) V.row(static_cast<Eigen::Index>(i)) = rest.row(vertices[i]);
  MatrixX3i F(triangles.rows(), 3);
  for (Eigen::Index f = 0; f < F.rows(); ++f)
    for (int k = 0; k < 3; ++k)
      F(f, k) =
          static_cast<int>(std::lower_bound(vertices.begin(), vertices.end(), triangles(f, k)) - vertices.begin());
  return {V, F, std::move(vertices)};
}

Obstacle Obstacle::rigid(const TriangleMesh& mesh) {
  return {mesh.V, mesh.F, {}};
}

Obstacle::Obstacle(const MatrixX3d& V, const MatrixX3i& F, std::vector<int> vertices)
    : V_(V), F_(F), neighbours_(triangle_neighbours(F)), vertices_(std::move(vertices)), query_(V, F) {
  on_rim_.assign(static_cast<std::size_t>(V_.rows()), 0);
  for (Eigen::Index f = 0; f < F_.rows(); ++f)
    for (int k = 0; k < 3; ++k)
      if (neighbours_(f, k) < 0)
        on_rim_[static_cast<std::size_t>(F_(f, k))] = on_rim_[static_cast<std::size_t>(F_(f, (k + 1) % 3))] = 1;
  for (std::size_t i = 0; i < vertices_.size(); ++i) local_.emplace_back(vertices_[i], static_cast<int>(i));
  low_ = V_.colwise().minCoeff();
  high_ = V_.colwise().maxCoeff();
  ring_start_.assign(static_cast<std::size_t>(V_.rows()) + 1, 0);
  for (Eigen::Index i = 0; i < F_.size(); ++i) ++ring_start_[static_cast<std::size_t>(F_.data()[i]) + 1];
  std::partial_sum(ring_start_.begin(), ring_start_.end(), ring_start_.begin());
  ring_.resize(static_cast<std::size_t>(F_.size()));
  std::vector<int> next(ring_start_.begin(), ring_start_.end() - 1);
  for (Eigen::Index f = 0; f < F_.rows(); ++f)
    for (int k = 0; k < 3; ++k)
      ring_[static_cast<std::size_t>(next[static_cast<std::size_t>(F_(f, k))]++)] = static_cast<int>(f);
}

Vector3d Obstacle::face_normal(int face) const {
  const Vector3d a = V_.row(F_(face, 0)), b = V_.row(F_(face, 1)), c = V_.row(F_(face, 2));
  return (b - a).cross(c - a).normalized();
}

/// Angle-weighted, so that the sign of the distance is right beside the vertex.
Vector3d Obstacle::vertex_normal(int vertex) const {
  Vector3d sum = Vector3d::Zero();
  const auto v = static_cast<std::size_t>(vertex);
  for (int i = ring_start_[v]; i < ring_start_[v + 1]; ++i) {
    const int f = ring_[static_cast<std::size_t>(i)];
    int k = 0;
    while (F_(f, k) != vertex) ++k;
    const Vector3d p = V_.row(vertex);
    const Vector3d a = V_.row(F_(f, (k + 1) % 3)).transpose() - p, b = V_.row(F_(f, (k + 2) % 3)).transpose() - p;
    const Vector3d n = a.cross(b);
    const double length = n.norm();
    if (length > 0) sum += std::atan2(length, a.dot(b)) / length * n;
  }
  return sum.normalized();
}

void Obstacle::place(const Eigen::Isometry3d& transform) {
  double longest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d p((corner & 1) != 0 ? high_.x() : low_.x(), (corner & 2) != 0 ? high_.y() : low_.y(),
                     (corner & 4) != 0 ? high_.z() : low_.z());
    longest = std::max(longest, (transform * p - transform_ * p).norm());
  }
  travel_ += longest;
  transform_ = transform;
}

void Obstacle::follow(const PositionView& positions) {
  double longest2 = 0;
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const Vector3d p = positions[vertices_[i]];
    longest2 = std::max(longest2, (p - V_.row(row).transpose()).squaredNorm());
    V_.row(row) = p;
  }
  if (longest2 == 0) return;
  travel_ += std::sqrt(longest2);
  refitted_ = false;
}

void Obstacle::refit() {
  if (!refitted_) query_.refit(V_);
  refitted_ = true;
}

Vector3d Obstacle::point(const SignedContact& contact) const {
  const Vector3d p = (contact.barycentric.transpose() * V_(F_.row(contact.triangle), Eigen::all)).transpose();
  return is_rigid() ? Vector3d(transform_ * p) : p;
}

std::vector<int> Obstacle::shared_edges(const Obstacle& other) const {
  std::vector<int> edges;
  if (is_rigid() || other.is_rigid()) return edges;
  const auto shared = [&](int v) { return other.has_vertex(vertices_[static_cast<std::size_t>(v)]); };
  for (Eigen::Index f = 0; f < F_.rows(); ++f)
    for (int k = 0; k < 3; ++k) {
      const int a = F_(f, k), b = F_(f, (k + 1) % 3);
      if (neighbours_(f, k) < 0 && shared(a) && shared(b)) edges.insert(edges.end(), {a, b});
    }
  return edges;
}

double Obstacle::way_over(const std::vector<int>& edges, const Vector3d& p, const SignedContact& closest) const {
  const Vector3d q = point(closest);
  double shortest = std::numeric_limits<double>::infinity();
  for (std::size_t e = 0; e < edges.size(); e += 2) {
    const Vector3d a = V_.row(edges[e]), along = V_.row(edges[e + 1]).transpose() - a;
    const double length2 = std::max(along.squaredNorm(), std::numeric_limits<double>::min());
    for (const Vector3d& end : {p, q}) {
      const Vector3d s = a + std::clamp(along.dot(end - a) / length2, 0.0, 1.0) * along;
      shortest = std::min(shortest, (p - s).norm() + (s - q).norm());
    }
  }
  return shortest;
}

std::optional<SignedContact> Obstacle::closest(const Vector3d& point, double reach, int hint) const {
  const Vector3d p = is_rigid() ? Vector3d(transform_.inverse() * point) : point;
  if (hint >= 0 && hint < F_.rows()) {
    const Vector3d a = V_.row(F_(hint, 0)), b = V_.row(F_(hint, 1)), c = V_.row(F_(hint, 2));
    const Vector3d w = closest_barycentric(p, a, b, c);
    // A little more than the distance to that triangle, so that the search finds it or a nearer one.
    reach = std::min(reach, (1 + 1e-9) * (p - w[0] * a - w[1] * b - w[2] * c).norm() + 1e-12);
  }
  const std::optional<SurfacePoint> near = query_.closest_point_within(p, reach);
  if (!near) return std::nullopt;
  const int f = near->triangle;
  SignedContact contact;
  contact.triangle = f;
  contact.barycentric = near->barycentric;
  Vector3d normal = face_normal(f);
  constexpr double crease = 0.5;  // 151 degrees between the normals
  const int zeros = static_cast<int>((near->barycentric.array() == 0).count());
  if (zeros == 1) {
    for (int k = 0; k < 3; ++k) {
      if (near->barycentric[(k + 2) % 3] != 0) continue;
      const int across = neighbours_(f, k);
      contact.on_rim = across < 0;
      if (across < 0) continue;
      normal += face_normal(across);
      // The faces of a sharp crease almost cancel, and cross where it is pressed flat: its surroundings tell the sides.
      if (normal.norm() < crease)
        for (const int end : {k, (k + 1) % 3}) normal += near->barycentric[end] * vertex_normal(F_(f, end));
      normal.normalize();
    }
  } else if (zeros == 2) {
    Eigen::Index k = 0;
    near->barycentric.maxCoeff(&k);
    contact.on_rim = on_rim_[static_cast<std::size_t>(F_(f, k))] != 0;
    normal = vertex_normal(F_(f, k));
  }
  const Vector3d r = p - near->position;
  const double distance = std::sqrt(near->squared_distance);
  const double sign = r.dot(normal) >= 0 ? 1 : -1;
  contact.gap = sign * distance;
  // Beside an edge or a vertex the gradient of the distance is the direction to the closest point; too close to have a
  // direction, the pseudo-normal stands in.
  constexpr double resolvable = 2e-5;
  if (zeros > 0 && distance > resolvable) normal = sign * r / distance;
  contact.normal = is_rigid() ? Vector3d(transform_.linear() * normal) : normal;
  return contact;
}

std::vector<SignedContact> Obstacle::beside(const Vector3d& point, const SignedContact& closest, double reach) const {
  constexpr double same_plane = 0.9995, other_side = -0.2;
  constexpr double behind = 1e-5;  // metres
  constexpr std::size_t most = 2;
  const Vector3d p = is_rigid() ? Vector3d(transform_.inverse() * point) : point;
  const auto local = [&](const Vector3d& n) { return is_rigid() ? Vector3d(transform_.linear().transpose() * n) : n; };
  struct Candidate {
    double distance;
    SignedContact contact;
    Vector3d middle, at;
  };
  std::vector<Candidate> candidates;
  const Vector3d first_normal = local(closest.normal);
  for (const int f : query_.triangles_in_box(p.array() - reach, p.array() + reach)) {
    if (f == closest.triangle) continue;
    const Vector3d n = face_normal(f);
    const double turn = n.dot(first_normal);
    if (turn > same_plane || turn < other_side) continue;
    const Vector3d a = V_.row(F_(f, 0)), b = V_.row(F_(f, 1)), c = V_.row(F_(f, 2));
    const Vector3d w = closest_barycentric(p, a, b, c);
    const Vector3d at = w[0] * a + w[1] * b + w[2] * c;
    const double distance = (p - at).norm();
    if (distance > reach) continue;
    SignedContact contact;
    contact.triangle = f;
    contact.barycentric = w;
    contact.normal = n;
    contact.gap = n.dot(p - at);
    // Behind its plane the face can only be left beside it: it is no wall for this point.
    if (contact.gap < std::min(0.0, closest.gap) - behind) continue;
    candidates.push_back({distance, contact, (a + b + c) / 3, at});
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& x, const Candidate& y) { return x.distance < y.distance; });
  std::vector<SignedContact> kept;
  // A plane is given by a point and a normal; the closest point lies `gap` below p along the first normal.
  std::vector<std::pair<Vector3d, Vector3d>> planes{{p - closest.gap * first_normal, first_normal}};
  for (const Candidate& candidate : candidates) {
    bool stands_up = true;
    for (const auto& [at, n] : planes)
      stands_up = stands_up && n.dot(candidate.middle - at) > 0 && n.dot(candidate.contact.normal) < same_plane;
    if (!stands_up) continue;
    planes.emplace_back(candidate.at, candidate.contact.normal);
    kept.push_back(candidate.contact);
    if (is_rigid()) kept.back().normal = transform_.linear() * kept.back().normal;
    if (kept.size() == most) break;
  }
  return kept;
}

bool Obstacle::has_vertex(int vertex) const {
  return std::binary_search(vertices_.begin(), vertices_.end(), vertex);
}

Vector3d Obstacle::normal_at(int vertex) const {
  const auto found = std::lower_bound(local_.begin(), local_.end(), std::make_pair(vertex, -1));
  if (found == local_.end() || found->first != vertex) return Vector3d::Zero();
  return vertex_normal(found->second);
}

}  // namespace phiz
