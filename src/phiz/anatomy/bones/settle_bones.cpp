// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/bones/settle_bones.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>

#include "phiz/anatomy/bones/implicit.h"
#include "phiz/core/error.h"
#include "phiz/geometry/coarsen.h"
#include "phiz/geometry/remesh.h"
#include "phiz/geometry/spatial_query.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/topology.h"
#include "phiz/geometry/untangle.h"
#include "phiz/geometry/validate.h"

namespace phiz {
namespace {

MatrixX3i all_triangles(const BoneEnvelope& skin) {
  MatrixX3i F(skin.outer.rows() + skin.inner.rows(), 3);
  F << skin.outer, skin.inner;
  return F;
}

/// Room for bone at a point: positive where bone may be, metres.
struct Room {
  double usual;  ///< under flesh of the usual thickness
  double least;  ///< under the least flesh
};

/// Measures the room that the skin leaves.
class RoomQuery {
 public:
  RoomQuery(const BoneEnvelope& skin, const BoneOptions& options)
      : options_(options),
        outer_count_(skin.outer.rows()),
        F_(all_triangles(skin)),
        normals_(vertex_normals(skin.V, F_)),
        whole_(skin.V, F_),
        outer_(skin.V, skin.outer),
        inner_(skin.V, skin.inner) {}

  Room operator()(const Vector3d& p) const {
    const double least = options_.least_flesh;
    const double usual = options_.usual_flesh ? std::max(least, options_.usual_flesh(p)) : least;
    const auto near = whole_.closest_point_within(p, reach);
    if (!near) return {reach - usual, reach - least};
    const double distance = std::sqrt(near->squared_distance);
    const bool is_inner = near->triangle >= outer_count_;
    if (distance < overshoot && !is_inside(p, *near)) {
      const double inner = -distance - options_.inner_clearance;
      return is_inner ? Room{inner, inner} : Room{-distance - usual, -distance - least};
    }
    const double outer = is_inner ? other(outer_, p, distance) : distance;
    const double inner = (is_inner ? distance : other(inner_, p, distance)) - options_.inner_clearance;
    return {std::min(outer - usual, inner), std::min(outer - least, inner)};
  }

 private:
  static constexpr double reach = 0.025;      // nothing farther away matters
  static constexpr double overshoot = 0.010;  // no bone shape reaches farther out of the skin

  static double other(const SurfaceQuery& sheet, const Vector3d& p, double at_least) {
    const auto near = sheet.closest_point_within(p, reach);
    return near ? std::max(at_least, std::sqrt(near->squared_distance)) : reach;
  }

  /// By the normal of the nearest point; where that is not clear, by the winding number.
  bool is_inside(const Vector3d& p, const SurfacePoint& near) const {
    Vector3d normal = Vector3d::Zero();
    for (int k = 0; k < 3; ++k) normal += near.barycentric(k) * normals_.row(F_(near.triangle, k)).transpose();
    const Vector3d away = p - near.position;
    const double along = normal.dot(away);
    if (std::abs(along) > 0.5 * normal.norm() * away.norm()) return along < 0;
    return whole_.is_inside(p);
  }

  BoneOptions options_;
  Eigen::Index outer_count_;
  MatrixX3i F_;
  MatrixX3d normals_;
  SurfaceQuery whole_, outer_, inner_;
};

/// The component with the largest volume.
TriangleMesh main_part(const TriangleMesh& mesh, const char* name) {
  if (mesh.F.rows() == 0) fail(std::string("the skin leaves no room for the ") + name);
  const VectorXi component = triangle_components(mesh.F);
  VectorXd volume = VectorXd::Zero(component.maxCoeff() + 1);
  for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
    const Vector3d a = mesh.V.row(mesh.F(f, 0)), b = mesh.V.row(mesh.F(f, 1)), c = mesh.V.row(mesh.F(f, 2));
    volume(component(f)) += a.dot(b.cross(c));
  }
  Eigen::Index best = 0;
  volume.maxCoeff(&best);
  MatrixX3i F(mesh.F.rows(), 3);
  Eigen::Index count = 0;
  for (Eigen::Index f = 0; f < mesh.F.rows(); ++f)
    if (component(f) == best) F.row(count++) = mesh.F.row(f);
  F.conservativeResize(count, 3);
  return remove_unused_vertices(mesh.V, F).mesh;
}

Box bounds(const MatrixX3d& V) {
  return {V.colwise().minCoeff().transpose(), V.colwise().maxCoeff().transpose()};
}

/// Long triangles cut corners at the joint: moves the mandible away from the skull until it keeps about `gap` and no
/// triangles cross, withdrawing into itself where it must.
void separate(TriangleMesh& mandible, const TriangleMesh& skull, double gap) {
  constexpr double step = 0.0005;
  TriangleMesh around = skull;
  around.F.col(1).swap(around.F.col(2));  // the mandible lies on the inner side of the skull turned inside out
  const int skull_faces = static_cast<int>(skull.F.rows());
  const MatrixX3d skull_normals = triangle_normals(skull.V, skull.F);
  const auto uncross = [&] {
    for (int pass = 0; pass < 40; ++pass) {
      const MatrixX3d normals = vertex_normals(mandible.V, mandible.F);
      MatrixX3d move = MatrixX3d::Zero(mandible.V.rows(), 3);
      bool crossing = false;
      for (const auto& [a, b] : self_intersections(joined(std::array{skull, mandible}))) {
        if (a >= skull_faces || b < skull_faces) continue;
        crossing = true;
        for (int k = 0; k < 3; ++k) {
          const int v = mandible.F(b - skull_faces, k);
          move.row(v) = step * (0.5 * skull_normals.row(a) - normals.row(v)).normalized();
        }
      }
      if (!crossing) return;
      mandible.V += move;
    }
  };
  for (int round = 0; round < 3; ++round) {  // each of the three may undo a little of the others' work
    keep_clear(mandible, around, gap);
    uncross();
    untangle(mandible, 30);
  }
}

/// The zero set of `field` as the simulation needs it: clear of the skin and free of crossings. Where long triangles
/// cannot do that, shorter ones are tried.
TriangleMesh clear_surface(const ScalarField& field, const TriangleMesh& skin, double edge_length, double clearance,
                           const char* name) {
  TriangleMesh mesh;
  for (const double finer : {1.0, 0.7, 0.5, 0.3}) {
    mesh = bone_surface(field, skin.V, finer * edge_length, name);
    keep_clear(mesh, skin, clearance);
    if (untangle(mesh, 30)) return mesh;
  }
  require_no_self_intersections(mesh, name);
  return mesh;
}

}  // namespace

void keep_clear(TriangleMesh& bone, const TriangleMesh& skin, double least) {
  constexpr double step = 0.0006;
  const MatrixX3d skin_normals = vertex_normals(skin.V, skin.F);
  const SurfaceQuery skin_query(skin);
  for (int pass = 0; pass < 14; ++pass) {
    MatrixX3d move = MatrixX3d::Zero(bone.V.rows(), 3);
    bool moved = false;
    const auto push = [&](int v, double distance, const Vector3d& inward) {
      const Vector3d by = std::min(distance, step) * inward;
      if (by.squaredNorm() > move.row(v).squaredNorm()) move.row(v) = by;
      moved = true;
    };
    const SurfaceQuery bone_query(bone);
    for (Eigen::Index s = 0; s < skin.V.rows(); ++s) {
      const Vector3d p = skin.V.row(s), inward = -skin_normals.row(s);
      const auto near = bone_query.closest_point_within(p, 3 * least);
      if (!near) continue;
      const double depth = (near->position - p).dot(inward);  // how far below the skin the bone is
      const double distance = std::sqrt(near->squared_distance);
      const double clear = depth > -0.5 * distance ? distance : -distance;
      if (clear >= least) continue;
      for (int k = 0; k < 3; ++k)
        push(bone.F(near->triangle, k), (least - clear) * (0.4 + 0.6 * near->barycentric(k)), inward);
    }
    for (Eigen::Index v = 0; v < bone.V.rows(); ++v) {
      const Vector3d p = bone.V.row(v);
      const auto near = skin_query.closest_point_within(p, 3 * least);
      if (!near) continue;
      Vector3d inward = Vector3d::Zero();
      for (int k = 0; k < 3; ++k)
        inward -= near->barycentric(k) * skin_normals.row(skin.F(near->triangle, k)).transpose();
      const double distance = std::sqrt(near->squared_distance);
      const double clear = inward.dot(p - near->position) > -0.2 * distance ? distance : -distance;
      if (clear < least) push(static_cast<int>(v), least - clear, inward.normalized());
    }
    if (!moved) return;
    bone.V += move;
  }
}

ClippedBones clip_bones(const BoneShape& skull, const BoneShape& mandible, const BoneEnvelope& skin,
                        const BoneOptions& options) {
  constexpr double soft = 0.002, far = 0.0025, deep = 0.02;
  const auto room = std::make_shared<RoomQuery>(skin, options);
  const auto clip = [room](const BoneShape& bone, double f, const Vector3d& p) {
    if (f > far || f < -deep) return f;
    const Room here = (*room)(p);
    const double usual = implicit::intersect(f, -here.usual, soft);
    if (!bone.struts) return usual;
    return implicit::blend(usual, implicit::intersect(bone.struts(p), -here.least, 0.5 * soft), 1.5 * soft);
  };
  const double gap = options.joint_gap;
  return {[=](const Vector3d& p) {
            const double f = skull.shape(p);
            if (f > far) return f;
            return std::max(clip(skull, f, p), gap - mandible.shape(p));  // positive too near to the mandible
          },
          [=](const Vector3d& p) { return clip(mandible, mandible.shape(p), p); }};
}

TriangleMesh bone_surface(const ScalarField& bone, const MatrixX3d& around, double edge_length, const char* name) {
  constexpr double finest_shape = 0.0032;  // longer edges than the thin parts need come from coarsening
  PolygoniseOptions options;
  options.edge_length = std::min(edge_length, finest_shape);
  options.lipschitz = 1.5;
  options.projection_steps = 1;
  const TriangleMesh even = main_part(polygonise(bone, bounds(around), options), name);
  if (edge_length <= finest_shape) return even;
  const double area = 0.5 * triangle_area_normals(even.V, even.F).rowwise().norm().sum();
  for (const double more : {1.0, 1.4, 2.0}) {
    TriangleMesh fewer = decimate(even, static_cast<int>(more * area / (0.433 * edge_length * edge_length)));
    if (self_intersections(fewer).empty()) return fewer;
  }
  // Real bones have sheets and arches so thin that evening out and decimation make their sides cross. The zero set as
  // it comes out of the lattice does not cross itself, and hardly does where edges stay in proportion to thickness.
  options.edge_length = 0.6 * finest_shape;
  options.improve = false;
  options.projection_steps = 0;
  const TriangleMesh raw = main_part(polygonise(bone, bounds(around), options), name);
  CoarsenOptions coarser;
  coarser.edge_length = [edge_length](const Vector3d&) { return edge_length; };
  TriangleMesh fewer;
  for (const double slenderness : {2.5, 1.5, 1.0}) {
    coarser.slenderness = slenderness;
    fewer = coarsen(raw, coarser);
    if (self_intersections(fewer).empty()) break;
  }
  return fewer;
}

BoneSurfaces settle_bones(const ClippedBones& fields, const TriangleMesh& simulated_skin, const BoneOptions& options) {
  const double clearance = 0.8 * options.inner_clearance;
  for (const double finer : {1.0, 0.8, 0.6}) {
    BoneSurfaces bones{
        clear_surface(fields.skull, simulated_skin, finer * options.skull_edge, clearance, "skull"),
        clear_surface(fields.mandible, simulated_skin, finer * options.mandible_edge, clearance, "mandible")};
    separate(bones.mandible, bones.skull, 0.6 * options.joint_gap);
    const TriangleMesh skin{simulated_skin.V, simulated_skin.F, {}, {}};
    if (self_intersections(joined(std::array{skin, bones.skull, bones.mandible})).empty()) return bones;
  }
  fail("skull, mandible and skin could not be kept apart", "use a finer size");
}

}  // namespace phiz
