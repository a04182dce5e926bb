// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/open/registration.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "phiz/anatomy/open/face_kit_layout.h"
#include "phiz/geometry/solidify.h"
#include "phiz/geometry/spatial_query.h"
#include "phiz/geometry/surface.h"

namespace phiz {

namespace {

Box box_round(const std::vector<const TriangleMesh*>& meshes) {
  Box box{Vector3d::Constant(1e9), Vector3d::Constant(-1e9)};
  for (const TriangleMesh* mesh : meshes) {
    box.low = box.low.cwiseMin(mesh->V.colwise().minCoeff().transpose());
    box.high = box.high.cwiseMax(mesh->V.colwise().maxCoeff().transpose());
  }
  return box;
}

TriangleMesh solid(const BodyParts& parts, BodyPartKind kind, int triangles) {
  constexpr double cell = 0.0008, gap = 0.0025;
  constexpr double hidden = 0.87;  // of all directions end in bone: inside of the braincase and the nasal cavity
  std::vector<const TriangleMesh*> meshes;
  for (const BodyPartName& part : needed_body_parts())
    if (part.kind == kind) meshes.push_back(&parts.at(part.fma));
  const VoxelGrid grid = grid_round(box_round(meshes), cell, gap + 4 * cell);
  VoxelFlags cells(static_cast<std::size_t>(grid.count()), 0);
  for (const TriangleMesh* mesh : meshes) fill_inside(grid, *mesh, cells);
  fill_caves(grid, hidden, 4, cells);
  seal_gaps(grid, gap, cells);
  PolygoniseOptions options;
  options.edge_length = 0.0018;
  options.projection_steps = 1;
  options.improve = false;
  const Box box{grid.centre(0), grid.centre(grid.count() - 1)};
  return decimate(polygonise(signed_distance_field(grid, cells), box, options), triangles);
}

/// Centres of the eyeballs, left first: one mesh holds both.
std::pair<Vector3d, Vector3d> eye_centres(const BodyParts& parts) {
  const MatrixX3d& V = parts.at(12513).V;
  const double middle = 0.5 * (V.col(0).minCoeff() + V.col(0).maxCoeff());
  std::vector<int> left, right;
  for (int v = 0; v < V.rows(); ++v) (V(v, 0) > middle ? left : right).push_back(v);
  const auto centre = [&V](std::vector<int> rows) {
    constexpr double off = 0.0015;  // metres from the sphere: optic nerve, cornea
    Sphere ball = fit_sphere(V(rows, Eigen::all));
    for (int round = 0; round < 8; ++round) {
      std::vector<int> near;
      for (const int v : rows)
        if (std::abs((V.row(v).transpose() - ball.centre).norm() - ball.radius) < off) near.push_back(v);
      if (near.size() < rows.size() / 4) break;
      ball = fit_sphere(V(near, Eigen::all));
    }
    return ball.centre;
  };
  return {centre(left), centre(right)};
}

std::vector<Vector3d> tooth_crowns(const BodyParts& parts) {
  std::vector<Vector3d> crowns;
  for (const face_kit::Tooth& tooth : face_kit::teeth)
    crowns.push_back(
        crown_centre(parts.at(tooth.fma).V, tooth.upper ? Vector3d::UnitY() : Vector3d(-Vector3d::UnitY())));
  return crowns;
}

/// The vertices farthest up, back, left and right, above `lowest`.
std::array<Vector3d, 4> vault_ends(const MatrixX3d& V, double lowest) {
  const std::array<Vector3d, 4> directions{Vector3d(0, 1, 0), Vector3d(0, 0, -1), Vector3d(1, 0, 0),
                                           Vector3d(-1, 0, 0)};
  std::array<Vector3d, 4> ends;
  for (std::size_t d = 0; d < ends.size(); ++d) {
    double best = -1e9;
    for (Eigen::Index v = 0; v < V.rows(); ++v) {
      if (V(v, 1) < lowest || V.row(v).dot(directions[d]) <= best) continue;
      best = V.row(v).dot(directions[d]);
      ends[d] = V.row(v);
    }
  }
  return ends;
}

/// Similarity by upper teeth, eyes and the ends of the vault, which depend on how the head is turned: three rounds.
void align(const BodyParts& parts, const BoneSolids& solids, const FaceGuide& guide, SpaceMap& map) {
  constexpr double scalp = 0.006, above_eye = 0.030;
  const std::vector<Vector3d> crowns = tooth_crowns(parts);
  const auto [left_eye, right_eye] = eye_centres(parts);
  const auto goals = vault_ends(guide.outer_skin.V, guide.left_eye.y() + above_eye);
  const std::array<int, 4> anchors{1, 6, 7, 12};  // first molars and central incisors of the upper jaw
  for (int round = 0; round < 3; ++round) {
    Eigen::Matrix3Xd from(3, 10), to(3, 10);
    Eigen::Index column = 0;
    const auto add = [&](const Vector3d& a, const Vector3d& b) {
      from.col(column) = a;
      to.col(column++) = b;
    };
    for (const int a : anchors) add(crowns[static_cast<std::size_t>(a)], guide.crowns[static_cast<std::size_t>(a)]);
    add(left_eye, guide.left_eye);
    add(right_eye, guide.right_eye);
    // The ends as seen with the present rotation.
    const MatrixX3d turned = solids.skull.V * map.rotation.transpose();
    const auto ends = vault_ends(turned, (map.rotation * left_eye).y() + above_eye);
    for (std::size_t e = 0; e < ends.size(); ++e) {
      const Vector3d outward =
          std::array<Vector3d, 4>{Vector3d(0, 1, 0), Vector3d(0, 0, -1), Vector3d(1, 0, 0), Vector3d(-1, 0, 0)}[e];
      Vector3d goal = goals[e] - scalp * outward;
      Vector3d end = ends[e];
      // Only the coordinate along the axis is known; the others may be anywhere on the vault.
      const Vector3d now = map.scale * end + map.translation;
      if (round > 0) goal = now + (goal - now).dot(outward) * outward;
      add(map.rotation.transpose() * end, goal);
    }
    const Eigen::Matrix4d T = Eigen::umeyama(from, to, true);
    map.scale = std::cbrt(T.topLeftCorner<3, 3>().determinant());
    map.rotation = T.topLeftCorner<3, 3>() / map.scale;
    map.translation = T.topRightCorner<3, 1>();
  }
}

/// Vertices about `spacing` apart that stand out into the open: the first in each cell of a lattice from which most
/// directions away from the bone are free. Not the walls of orbits and of the nasal cavity.
std::vector<int> open_vertices(const TriangleMesh& bone, double spacing) {
  constexpr double least_open = 0.72, lift = 0.0005;
  constexpr int rays = 64;
  const SurfaceQuery query(bone);
  const MatrixX3d normals = vertex_normals(bone.V, bone.F);
  std::map<std::tuple<int, int, int>, int> first;
  for (int v = 0; v < bone.V.rows(); ++v) {
    const Eigen::Array3i cell = (bone.V.row(v).array() / spacing).floor().cast<int>();
    first.emplace(std::tuple(cell[0], cell[1], cell[2]), v);
  }
  std::vector<int> rows;
  for (const auto& [cell, v] : first) {
    const Vector3d normal = normals.row(v), p = bone.V.row(v).transpose() + lift * normal;
    int free = 0, all = 0;
    for (const Vector3d& direction : sphere_directions(rays)) {
      if (direction.dot(normal) <= 0) continue;
      ++all;
      if (!query.first_hit(p, direction)) ++free;
    }
    if (free >= least_open * all) rows.push_back(v);
  }
  return rows;
}

/// Displacements that bring bone to its usual depth under the skin, where the skin lies over it.
class DepthGoals {
 public:
  explicit DepthGoals(const FaceGuide& guide)
      : guide_(guide), skin_(guide.outer_skin), normals_(vertex_normals(guide.outer_skin.V, guide.outer_skin.F)) {}

  /// Appends centre and displacement for every one of `rows` of a bone in its present place that faces the skin.
  void collect(const TriangleMesh& bone, const std::vector<int>& rows, bool is_mandible, std::vector<Vector3d>& centres,
               std::vector<Vector3d>& moves) const {
    constexpr double deepest = 0.030, known = 0.030, least_trust = 0.25;
    const MatrixX3d bone_normals = vertex_normals(bone.V, bone.F);
    for (const int v : rows) {
      const Vector3d p = bone.V.row(v);
      const SurfacePoint near = skin_.closest_point(p);
      Vector3d out = Vector3d::Zero();
      for (int k = 0; k < 3; ++k)
        out += near.barycentric(k) * normals_.row(guide_.outer_skin.F(near.triangle, k)).transpose();
      out.normalize();
      const double depth = (near.position - p).dot(out);
      if (std::abs(depth) > deepest || bone_normals.row(v).dot(out) < 0.5) continue;
      if (std::abs(depth) < 0.7 * std::sqrt(near.squared_distance)) continue;
      double sum = 0, weights = 0, nearest = 1;
      for (const ThicknessSite& site : guide_.sites) {
        if (site.on_mandible != is_mandible) continue;
        const double square = (near.position - site.skin).squaredNorm() + 1e-6;
        sum += site.thickness / (square * square);
        weights += 1 / (square * square);
        nearest = std::min(nearest, std::sqrt(square));
      }
      const double trust = std::max(least_trust, std::exp(-std::pow(nearest / known, 2)));
      centres.push_back(p);
      moves.push_back(trust * (depth - sum / weights) * out);
    }
  }

 private:
  const FaceGuide& guide_;
  SurfaceQuery skin_;
  MatrixX3d normals_;
};

}  // namespace

BoneSolids solid_bones(const BodyParts& parts) {
  return {solid(parts, BodyPartKind::skull, 40000), solid(parts, BodyPartKind::mandible, 12000)};
}

MatrixX3d SpaceMap::operator()(const MatrixX3d& points) const {
  MatrixX3d moved = ((scale * points * rotation.transpose()).rowwise() + translation.transpose());
  for (const Rbf& displacement : displacements) moved += displacement.evaluate(moved);
  return moved;
}

SpaceMap register_anatomy(const BodyParts& parts, const BoneSolids& solids, const FaceGuide& guide,
                          const RegistrationOptions& options) {
  SpaceMap map;
  align(parts, solids, guide, map);
  const DepthGoals goals(guide);
  TriangleMesh skull = solids.skull, mandible = solids.mandible;
  skull.V = map(skull.V);
  mandible.V = map(mandible.V);
  const std::vector<int> skull_rows = open_vertices(skull, options.sample_spacing);
  const std::vector<int> mandible_rows = open_vertices(mandible, options.sample_spacing);
  std::vector<Vector3d> firm = tooth_crowns(parts), firm_goals(guide.crowns.begin(), guide.crowns.end());
  const auto [left_eye, right_eye] = eye_centres(parts);
  firm.insert(firm.end(), {left_eye, right_eye});
  firm_goals.insert(firm_goals.end(), {guide.left_eye, guide.right_eye});
  MatrixX3d firm_now = map(rows_of(firm));
  for (const double smoothing : options.smoothing) {
    std::vector<Vector3d> centres, moves;
    for (Eigen::Index i = 0; i < firm_now.rows(); ++i) {
      centres.push_back(firm_now.row(i));
      moves.push_back(firm_goals[static_cast<std::size_t>(i)] - centres.back());
    }
    goals.collect(skull, skull_rows, false, centres, moves);
    goals.collect(mandible, mandible_rows, true, centres, moves);
    const Rbf displacement(rows_of(centres), rows_of(moves), RbfKernel::biharmonic, smoothing);
    for (MatrixX3d* points : {&skull.V, &mandible.V, &firm_now}) *points += displacement.evaluate(*points);
    map.displacements.push_back(displacement);
  }
  return map;
}

}  // namespace phiz
