// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/people/reshape_head.h"

#include <Eigen/Dense>
#include <algorithm>
#include <vector>

#include "phiz/anatomy/bones/settle_bones.h"
#include "phiz/anatomy/head_measures.h"
#include "phiz/anatomy/people/reshaped_expressions.h"
#include "phiz/anatomy/skin_ride.h"
#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/geometry/improve_tets.h"
#include "phiz/geometry/operators.h"
#include "phiz/geometry/spatial_query.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/topology.h"
#include "phiz/geometry/untangle.h"
#include "phiz/geometry/validate.h"
#include "phiz/numerics/cholesky.h"
#include "phiz/numerics/rbf.h"

namespace phiz {

namespace {

/// The map of space that fits the displacement of the skin.
class SpaceWarp {
 public:
  SpaceWarp(const MatrixX3d& skin, const MatrixX3d& displacement) : displacement_(fit(skin, displacement)) {}

  MatrixX3d operator()(const MatrixX3d& points) const { return points + displacement_.evaluate(points); }
  Vector3d operator()(const Vector3d& p) const { return p + displacement_(p); }
  Matrix3d gradient(const Vector3d& p) const { return Matrix3d::Identity() + displacement_.jacobian(p); }

  /// Unit normals at points, carried along.
  MatrixX3d normals(const MatrixX3d& points, const MatrixX3d& normals) const {
    MatrixX3d turned(normals.rows(), 3);
    parallel_for(normals.rows(), [&](Eigen::Index i) {
      turned.row(i) = gradient(points.row(i)).inverse().transpose() * normals.row(i).transpose();
    });
    return turned.rowwise().normalized();
  }

 private:
  static Rbf fit(const MatrixX3d& skin, const MatrixX3d& displacement) {
    constexpr Eigen::Index centres = 2000;
    constexpr double smoothing = 0.01;
    const std::vector<int> rows = farthest_points(skin, centres);
    return {skin(rows, Eigen::all), displacement(rows, Eigen::all), RbfKernel::biharmonic, smoothing};
  }

  Rbf displacement_;
};

/// Puts the tets of `head` (still as they were) under the simulation skin `skin`.
class VolumeFit {
 public:
  VolumeFit(const HeadTemplate& head, const SpaceWarp& warp, const TriangleMesh& skin)
      : head_(head), mesh_(head.volume), fixed_(static_cast<std::size_t>(head.volume.V.rows()), 0) {
    mesh_.V = warp(head.volume.V);
    const MatrixX3d moved = skin.V - MatrixX3d(mesh_.V(head.skin_vertices, Eigen::all));
    place(head.skin_vertices, skin.V);
    follow(moved);
    place_bone(Tissue::skull, skin);
    place_bone(Tissue::mandible, skin);
    improve();
  }

  const MatrixX3d& positions() const { return mesh_.V; }

 private:
  void place(const VectorXi& rows, const MatrixX3d& positions) {
    for (Eigen::Index i = 0; i < rows.size(); ++i) {
      mesh_.V.row(rows[i]) = positions.row(i);
      fixed_[static_cast<std::size_t>(rows[i])] = 1;
    }
  }

  void place_bone(Tissue tissue, const TriangleMesh& skin) {
    constexpr double clearance = 0.0012;  // metres; the gate is 1 mm
    CompactMesh bone = remove_unused_vertices(mesh_.V, region_boundary(head_.volume, tissue));
    keep_clear(bone.mesh, skin, clearance);
    place(bone.kept, bone.mesh.V);
  }

  /// The tets beside the skin follow the rest of its displacement, `moved`, that the warp is too smooth for, bones too:
  /// it fades within `reach` (screened Poisson equation). Small tets are stiffer.
  void follow(const MatrixX3d& moved) {
    constexpr double reach = 0.004;
    const VectorXd stiffness = tet_volumes(head_.volume.V, head_.volume.T).cwiseInverse();
    SparseMatrixd A = tet_laplacian(head_.volume.V, head_.volume.T, stiffness);
    VectorXd screen = VectorXd::Zero(A.rows());  // lumped mass, with that stiffness: a quarter per tet
    for (Eigen::Index t = 0; t < head_.volume.T.rows(); ++t)
      for (int k = 0; k < 4; ++k) screen[head_.volume.T(t, k)] += 0.25 / (reach * reach);
    A.diagonal() += screen;

    MatrixX3d right = MatrixX3d::Zero(A.rows(), 3);
    for (Eigen::Index i = 0; i < head_.skin_vertices.size(); ++i) right.row(head_.skin_vertices[i]) = moved.row(i);
    right = -(A * right).eval();
    std::vector<Eigen::Triplet<double>> entries;
    for (Eigen::Index v = 0; v < A.rows(); ++v)
      for (SparseMatrixd::InnerIterator it(A, v); it; ++it)
        if (!is_fixed(v) && !is_fixed(it.index())) entries.emplace_back(v, it.index(), it.value());
    for (Eigen::Index v = 0; v < A.rows(); ++v)
      if (is_fixed(v)) {
        entries.emplace_back(v, v, 1);
        right.row(v).setZero();
      }
    A.setFromTriplets(entries.begin(), entries.end());
    mesh_.V += SparseCholesky(A).solve(right);
  }

  /// Rounder tets, for which skin and bones give a little; the skin only as far as it does not cross itself.
  void improve() {
    constexpr double bone_give = 0.0002;  // metres
    ImproveOptions options;
    options.target = 8;
    options.give = VectorXd::Constant(mesh_.V.rows(), bone_give);
    const MatrixX3d before = mesh_.V;
    for (const double skin_give : {0.0005, 0.0002, 0.0}) {
      mesh_.V = before;
      for (const int v : head_.skin_vertices) options.give[v] = skin_give;
      smooth_tets(mesh_, options);
      if (self_intersections({mesh_.V, head_.skin_triangles, {}, {}}).empty()) return;
    }
  }

  bool is_fixed(Eigen::Index v) const { return fixed_[static_cast<std::size_t>(v)] != 0; }

  const HeadTemplate& head_;
  TetMesh mesh_;
  std::vector<char> fixed_;
};

/// Moves what lies in the tets with them, and the rest with the warp.
class Carry {
 public:
  Carry(const HeadTemplate& head, const MatrixX3d& positions, const SpaceWarp& warp)
      : T_(head.volume.T), positions_(positions), warp_(warp), query_(head.volume) {}

  MatrixX3d operator()(const MatrixX3d& points) const {
    MatrixX3d moved = warp_(points);
    const std::vector<TetPoint> places = query_.locate_all(points);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      const TetPoint& place = places[static_cast<std::size_t>(i)];
      if (place.tet < 0) continue;
      moved.row(i).setZero();
      for (int k = 0; k < 4; ++k) moved.row(i) += place.barycentric(k) * positions_.row(T_(place.tet, k));
    }
    return moved;
  }

  /// Whether all points lie in the tets.
  bool holds(const MatrixX3d& points) const {
    const std::vector<TetPoint> places = query_.locate_all(points);
    return std::all_of(places.begin(), places.end(), [](const TetPoint& place) { return place.tet >= 0; });
  }

 private:
  const MatrixX4i& T_;
  const MatrixX3d& positions_;
  const SpaceWarp& warp_;
  TetQuery query_;
};

void carry_muscles(HeadTemplate& head, const HeadTemplate& before, const SpaceWarp& warp, const Carry& carry) {
  for (Muscle& muscle : head.muscles) {
    for (MatrixX3d& fibre : muscle.fibres) fibre = carry(fibre);
    muscle.surface.V = carry(muscle.surface.V);
    // With the warp, not with the tets, whose inner vertices were moved for their shape.
    parallel_for(muscle.tets.size(), [&](Eigen::Index i) {
      const Vector3d centre = before.volume.V(before.volume.T.row(muscle.tets[i]), Eigen::all).colwise().mean();
      muscle.direction.row(i) = (warp.gradient(centre) * muscle.direction.row(i).transpose()).normalized();
    });
  }
}

JawJoint carried(const JawJoint& joint, const SpaceWarp& warp) {
  constexpr double condyle = 0.05;  // metres from the centre: where the axis ends
  JawJoint moved = joint;
  const Vector3d left = warp(Vector3d(joint.centre + condyle * joint.axis));
  const Vector3d right = warp(Vector3d(joint.centre - condyle * joint.axis));
  moved.centre = 0.5 * (left + right);
  moved.axis = (left - right).normalized();
  moved.up = (joint.up - joint.up.dot(moved.axis) * moved.axis).normalized();
  return moved;
}

/// A round eye behind its lids: as the skin about the eye moves and grows, and nowhere nearer to it than before.
void carry_eye(const std::string& name, const MatrixX3d& skin_before, const MatrixX3d& skin, Vector3d& centre,
               HeadTemplate& head) {
  constexpr double near = 1.15;  // of the radius: lids and the front of the socket
  Part* eye = nullptr;
  for (Part& part : head.parts)
    if (part.name == name) eye = &part;
  if (eye == nullptr) return;
  const double radius = (eye->mesh.V.rowwise() - centre.transpose()).rowwise().norm().maxCoeff();
  std::vector<int> rows;
  for (int v = 0; v < skin_before.rows(); ++v)
    if ((skin_before.row(v).transpose() - centre).norm() < near * radius) rows.push_back(v);
  if (rows.size() < 4) reject(head.name, "there is no skin about the " + name);
  // The similarity without rotation that fits these best.
  const MatrixX3d before = skin_before(rows, Eigen::all), after = skin(rows, Eigen::all);
  const Eigen::RowVector3d from = before.colwise().mean(), to = after.colwise().mean();
  const MatrixX3d arms = before.rowwise() - from;
  double scale = arms.cwiseProduct(after.rowwise() - to).sum() / arms.squaredNorm();
  const Vector3d moved = to.transpose() + scale * (centre - from.transpose());
  for (Eigen::Index i = 0; i < before.rows(); ++i)
    scale = std::min(scale, (after.row(i).transpose() - moved).norm() / (before.row(i).transpose() - centre).norm());
  eye->mesh.V = (scale * (eye->mesh.V.rowwise() - centre.transpose())).rowwise() + moved.transpose();
  centre = moved;
}

void carry_parts(HeadTemplate& head, const TriangleMesh& skin_before, const SpaceWarp& warp, const Carry& carry) {
  for (Part& part : head.parts) {
    if (part.carrier == Carrier::left_eye || part.carrier == Carrier::right_eye) continue;
    if (part.carrier == Carrier::flesh) {
      part.mesh.V = SkinRide(skin_before, part.mesh)(head.skin.V);
      continue;
    }
    const MatrixX3d before = part.mesh.V;
    part.mesh.V = carry.holds(before) ? carry(before) : warp(before);
    for (auto& [name, displacement] : part.shapes) displacement = warp(MatrixX3d(before + displacement)) - warp(before);
  }
}

/// Drawn bones under the drawn skin, which knows more than the simulation skin that they were carried with.
void clear_drawn_bones(HeadTemplate& head) {
  constexpr double clearance = 0.0013;  // metres; the gate is 1 mm
  const TriangleMesh skin = remove_unused_vertices(head.skin.V, outer_triangles(head)).mesh;
  for (Part& part : head.parts)
    if (part.name == "skull" || part.name == "mandible") keep_clear(part.mesh, skin, clearance);
}

void require_upright_tets(const HeadTemplate& head) {
  Eigen::Index worst = 0;
  const double volume = tet_volumes(head.volume.V, head.volume.T).minCoeff(&worst);
  if (volume <= 0)
    reject(head.name, "tet " + std::to_string(worst) + " turns over under the new skin: it is too different");
}

}  // namespace

HeadTemplate reshape_head(const HeadTemplate& head, const MatrixX3d& skin) {
  if (skin.rows() != head.skin.V.rows() || !skin.allFinite())
    throw Error(ErrorKind::usage, "the new skin of " + head.name + " needs " + std::to_string(head.skin.V.rows()) +
                                      " finite vertices, not " + std::to_string(skin.rows()));
  const MatrixX3d simulated = head.volume.V(head.skin_vertices, Eigen::all);
  const MatrixX3d displacement = head.skin_sampling * (skin - head.skin.V);
  const SpaceWarp warp(simulated, displacement);

  CompactMesh surface = remove_unused_vertices(head.volume.V, head.skin_triangles);
  if (surface.kept.size() != head.skin_vertices.size() || surface.kept != head.skin_vertices)
    reject(head.name, "its skin_vertices are not those of its skin_triangles in ascending order");
  TriangleMesh& new_skin = surface.mesh;
  new_skin.V = simulated + displacement;
  if (!untangle(new_skin, 40)) reject(head.name, "the new skin intersects itself and could not be mended");

  HeadTemplate result = head;
  result.identity = {};
  result.volume.V = VolumeFit(head, warp, new_skin).positions();
  require_upright_tets(result);
  result.skin.V = skin;
  const Carry carry(head, result.volume.V, warp);
  carry_muscles(result, head, warp, carry);
  carry_parts(result, head.skin, warp, carry);
  clear_drawn_bones(result);
  carry_eye("leftEye", head.skin.V, skin, result.left_eye_centre, result);
  carry_eye("rightEye", head.skin.V, skin, result.right_eye_centre, result);
  result.jaw = carried(head.jaw, warp);
  for (SkullLandmark& mark : result.skull_landmarks)
    mark.normal = warp.normals(head.volume.V.row(mark.bone_vertex), mark.normal.transpose()).row(0);
  result.attachments.normals =
      warp.normals(head.volume.V(head.attachments.vertices, Eigen::all), head.attachments.normals);
  result.expressions = reshaped_expressions(head, skin, result.jaw);
  translate(result, -result.jaw.centre);
  return result;
}

}  // namespace phiz
