// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/open/flesh_layer.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "phiz/geometry/surface.h"

namespace phiz {

namespace {

/// Triangles all of whose corners lie in mouth or eye sockets, or the others.
MatrixX3i sheet(const FaceKitSkin& skin, bool inner) {
  std::vector<char> member(static_cast<std::size_t>(skin.mesh.V.rows()), 0);
  for (const char* name : {"mouthBag", "leftSocket", "rightSocket"})
    for (const int v : skin.regions.at(name)) member[static_cast<std::size_t>(v)] = 1;
  std::vector<int> rows;
  for (int f = 0; f < skin.mesh.F.rows(); ++f) {
    bool all = true;
    for (int k = 0; k < 3; ++k) all = all && member[static_cast<std::size_t>(skin.mesh.F(f, k))];
    if (all == inner) rows.push_back(f);
  }
  return skin.mesh.F(rows, Eigen::all);
}

TriangleMesh floor_of(const FaceKitSkin& skin, std::span<const TriangleMesh> bones) {
  std::vector<TriangleMesh> sheets{{skin.mesh.V, sheet(skin, true), {}, {}}};
  for (const TriangleMesh& bone : bones) sheets.push_back({bone.V, bone.F, {}, {}});
  return joined(sheets);
}

}  // namespace

FleshLayer::FleshLayer(const FaceKitSkin& skin, std::span<const TriangleMesh> bones)
    : outer_(sheet(skin, false)),
      normals_(vertex_normals(skin.mesh.V, outer_)),
      skin_(skin.mesh.V, outer_),
      floor_(floor_of(skin, bones)) {}

FleshLayer::Room FleshLayer::room_at(const Vector3d& p) const {
  constexpr double over = 0.0015, under = 0.0006, deepest = 0.05;
  const SurfacePoint near = skin_.closest_point(p);
  Room room{near.position, Vector3d::Zero(), 0, 0};
  for (int k = 0; k < 3; ++k) room.out += near.barycentric(k) * normals_.row(outer_(near.triangle, k)).transpose();
  room.out.normalize();
  const auto below = floor_.first_hit(near.position, -room.out, 1e-5, deepest);
  const double thickness = below ? below->t : deepest;
  room.least = std::min(over, 0.35 * thickness);
  room.most = thickness - std::min(under, 0.2 * thickness);
  return room;
}

Vector3d FleshLayer::into_flesh(const Vector3d& p) const {
  const Room room = room_at(p);
  const double depth = (room.skin - p).dot(room.out);
  // Sideways offsets, at folds, are left as they are.
  return (depth - std::clamp(depth, room.least, room.most)) * room.out;
}

Vector3d FleshLayer::all_into_flesh(const MatrixX3d& points) const {
  const Room room = room_at(points.colwise().mean().transpose());
  const VectorXd depth = -((points.rowwise() - room.skin.transpose()) * room.out);
  const double low = depth.minCoeff(), high = depth.maxCoeff();
  const double down = std::max(0.0, room.least - low), up = std::max(0.0, high - room.most);
  const double deeper = high - low > room.most - room.least ? 0.5 * (room.least + room.most - low - high) : down - up;
  return -deeper * room.out;
}

}  // namespace phiz
