// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/bones.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "phiz/anatomy/bone_shapes.h"
#include "phiz/anatomy/flesh_thickness.h"
#include "phiz/anatomy/implicit.h"
#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/geometry/remesh.h"
#include "phiz/geometry/spatial_query.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/topology.h"

namespace phiz {
namespace {

using ScalarField = std::function<double(const Vector3d&)>;

MatrixX3i all_triangles(const BoneEnvelope& skin) {
  MatrixX3i F(skin.outer.rows() + skin.inner.rows(), 3);
  F << skin.outer, skin.inner;
  return F;
}

/// A sheet of skin that can be asked for its distance and on which side of it a point lies.
class Sheet {
 public:
  Sheet(const MatrixX3d& V, const MatrixX3i& F, const MatrixX3d& normals) : F_(F), normals_(normals), query_(V, F) {}

  /// Distance, negative on the outer side, to at most `limit`; `limit` when farther.
  double depth(const Vector3d& p, double limit) const {
    const auto near = query_.closest_point_within(p, limit);
    if (!near) return limit;
    Vector3d normal = Vector3d::Zero();
    for (int k = 0; k < 3; ++k) normal += near->barycentric(k) * normals_.row(F_(near->triangle, k)).transpose();
    const double distance = std::sqrt(near->squared_distance);
    return normal.dot(p - near->position) > 0 ? -distance : distance;
  }

 private:
  const MatrixX3i& F_;
  const MatrixX3d& normals_;
  SurfaceQuery query_;
};

/// Room for bone: positive where bone may be, metres.
class Room {
 public:
  Room(const Proportions& proportions, const BoneEnvelope& skin, const BoneOptions& options)
      : options_(options),
        thickness_(proportions),
        normals_(vertex_normals(skin.V, all_triangles(skin))),
        outer_(skin.V, skin.outer, normals_),
        inner_(skin.V, skin.inner, normals_) {}

  double operator()(const Vector3d& p) const {
    constexpr double reach = 0.025;
    const double outer = outer_.depth(p, reach), inner = inner_.depth(p, reach);
    if (std::abs(inner) < std::abs(outer) && inner < 0) return inner;
    if (std::abs(outer) <= std::abs(inner) && outer < 0) return outer;
    const double flesh = std::max(options_.least_flesh, thickness_(p));
    return std::min(std::abs(outer) - flesh, std::abs(inner) - options_.inner_clearance);
  }

 private:
  BoneOptions options_;
  ThicknessField thickness_;
  MatrixX3d normals_;
  Sheet outer_, inner_;
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

TriangleMesh surface(const ScalarField& field, const Box& box, double edge_length, const char* name) {
  PolygoniseOptions options;
  options.edge_length = edge_length;
  TriangleMesh mesh = main_part(polygonise(field, box, options), name);
  if (!self_intersections(mesh).empty()) {
    // Even triangles can fold on the thinnest ridges; the raw triangulation of the lattice cannot.
    options.improve = false;
    mesh = main_part(polygonise(field, box, options), name);
  }
  return mesh;
}

struct Fields {
  ScalarField skull, mandible;
};

/// Bone shapes of the person, cut to the room that the skin leaves.
Fields clipped_fields(const ReferenceWarp& warp, const Room& room, const BoneOptions& options) {
  constexpr double soft = 0.002, far = 0.008;
  const auto clip = [&room](double f, const Vector3d& p) {
    return f > far ? f : implicit::intersect(f, -room(p), soft);
  };
  return {[&warp, clip, &options](const Vector3d& p) {
            const Vector3d q = warp(p);
            const double f = reference_skull(q);
            if (f > far) return f;
            return clip(implicit::carve(f, reference_mandible(q) - options.joint_gap, soft), p);
          },
          [&warp, clip](const Vector3d& p) { return clip(reference_mandible(warp(p)), p); }};
}

/// Moves the vertices of `bone` that lie nearer to the skin than `least` away from it, and those of triangles that skin
/// vertices come nearer to.
void keep_clear(TriangleMesh& bone, const TriangleMesh& skin, double least) {
  const MatrixX3d skin_normals = vertex_normals(skin.V, skin.F);
  const SurfaceQuery skin_query(skin);
  for (int pass = 0; pass < 8; ++pass) {
    MatrixX3d move = MatrixX3d::Zero(bone.V.rows(), 3);
    bool moved = false;
    const auto push = [&](int v, const Vector3d& by) {
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
        push(bone.F(near->triangle, k), (least - clear) * (0.4 + 0.6 * near->barycentric(k)) * inward);
    }
    for (Eigen::Index v = 0; v < bone.V.rows(); ++v) {
      const Vector3d p = bone.V.row(v);
      const auto near = skin_query.closest_point_within(p, least);
      if (!near) continue;
      Vector3d inward = Vector3d::Zero();
      for (int k = 0; k < 3; ++k)
        inward -= near->barycentric(k) * skin_normals.row(skin.F(near->triangle, k)).transpose();
      push(static_cast<int>(v), (least - std::sqrt(near->squared_distance)) * inward.normalized());
    }
    if (!moved) return;
    bone.V += move;
  }
}

}  // namespace

BoneSurfaces build_bones(const Proportions& proportions, const BoneEnvelope& skin, const BoneOptions& options) {
  const ReferenceWarp warp(proportions);
  const Room room(proportions, skin, options);
  const Fields fields = clipped_fields(warp, room, options);
  const Box box = bounds(skin.V);
  BoneSurfaces bones{surface(fields.skull, box, options.edge_length, "skull"),
                     surface(fields.mandible, box, options.edge_length, "mandible")};
  const TriangleMesh all{skin.V, all_triangles(skin), {}, {}};
  keep_clear(bones.skull, all, 0.8 * options.inner_clearance);
  keep_clear(bones.mandible, all, 0.8 * options.inner_clearance);
  return bones;
}

BoneSurfaces build_drawn_bones(const Proportions& proportions, const BoneEnvelope& skin, const BoneOptions& options) {
  const ReferenceWarp warp(proportions);
  const Room room(proportions, skin, options);
  const Fields fields = clipped_fields(warp, room, options);
  const Box box = bounds(skin.V);
  constexpr double seam = 0.0015;
  const ScalarField skull = [&](const Vector3d& p) {
    return implicit::blend(fields.skull(p), upper_alveolar_process(proportions, p), seam);
  };
  const ScalarField mandible = [&](const Vector3d& p) {
    return implicit::blend(fields.mandible(p), lower_alveolar_process(proportions, p), seam);
  };
  return {surface(skull, box, options.edge_length, "skull"), surface(mandible, box, options.edge_length, "mandible")};
}

}  // namespace phiz
