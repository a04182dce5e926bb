// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/obstacle.h"

#include <algorithm>
#include <cmath>
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
  update_normals();
}

void Obstacle::update_normals() {
  face_normals_.resize(F_.rows(), 3);
  vertex_normals_.setZero(V_.rows(), 3);
  for (Eigen::Index f = 0; f < F_.rows(); ++f) {
    const Vector3d p[3] = {V_.row(F_(f, 0)), V_.row(F_(f, 1)), V_.row(F_(f, 2))};
    const Vector3d n = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
    face_normals_.row(f) = n;
    for (int k = 0; k < 3; ++k) {
      const Vector3d a = p[(k + 1) % 3] - p[k], b = p[(k + 2) % 3] - p[k];
      vertex_normals_.row(F_(f, k)) += std::atan2(a.cross(b).norm(), a.dot(b)) * n.transpose();
    }
  }
  vertex_normals_.rowwise().normalize();
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
  query_.refit(V_);
  update_normals();
}

std::optional<SignedContact> Obstacle::closest(const Vector3d& point, double reach) const {
  const Vector3d p = is_rigid() ? Vector3d(transform_.inverse() * point) : point;
  const std::optional<SurfacePoint> near = query_.closest_point_within(p, reach);
  if (!near) return std::nullopt;
  const int f = near->triangle;
  SignedContact contact;
  contact.triangle = f;
  contact.barycentric = near->barycentric;
  Vector3d normal = face_normals_.row(f);
  const int zeros = static_cast<int>((near->barycentric.array() == 0).count());
  if (zeros == 1) {
    for (int k = 0; k < 3; ++k) {
      if (near->barycentric[(k + 2) % 3] != 0) continue;
      const int across = neighbours_(f, k);
      contact.on_rim = across < 0;
      if (across >= 0) normal = (normal + face_normals_.row(across).transpose()).normalized();
    }
  } else if (zeros == 2) {
    Eigen::Index k = 0;
    near->barycentric.maxCoeff(&k);
    contact.on_rim = on_rim_[static_cast<std::size_t>(F_(f, k))] != 0;
    normal = vertex_normals_.row(F_(f, k));
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

bool Obstacle::has_vertex(int vertex) const {
  return std::binary_search(vertices_.begin(), vertices_.end(), vertex);
}

Vector3d Obstacle::normal_at(int vertex) const {
  const auto found = std::lower_bound(local_.begin(), local_.end(), std::make_pair(vertex, -1));
  if (found == local_.end() || found->first != vertex) return Vector3d::Zero();
  return vertex_normals_.row(found->second);
}

}  // namespace phiz
