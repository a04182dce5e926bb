// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/attachments.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "phiz/anatomy/face_frame.h"
#include "phiz/anatomy/muscle_table.h"
#include "phiz/geometry/spatial_query.h"
#include "phiz/geometry/topology.h"

namespace phiz {
namespace {

// Reaches of the rules, metres.
constexpr double origin_reach = 0.004, canthus_reach = 0.010, tooth_reach = 0.007, ligament_reach = 0.007,
                 gap_reach = 0.030;

bool is_flesh(int carrier) {
  return carrier == static_cast<int>(Carrier::flesh);
}

/// The surface of the bones where they touch soft tissue.
struct BoneSurface {
  MatrixX3i triangles;  ///< over rows of volume.V
  MatrixX3d normals;    ///< per vertex of the volume, outward from the bone; zero elsewhere
};

BoneSurface bone_surface(const HeadTemplate& head) {
  std::set<std::array<int, 3>> skin;
  const auto key = [](int a, int b, int c) {
    std::array<int, 3> k{a, b, c};
    std::sort(k.begin(), k.end());
    return k;
  };
  for (Eigen::Index f = 0; f < head.skin_triangles.rows(); ++f)
    skin.insert(key(head.skin_triangles(f, 0), head.skin_triangles(f, 1), head.skin_triangles(f, 2)));
  std::vector<char> soft(static_cast<std::size_t>(head.volume.V.rows()), 0);
  const VectorXi soft_rows = soft_tets(head);
  for (const int t : soft_rows)
    for (int k = 0; k < 4; ++k) soft[static_cast<std::size_t>(head.volume.T(t, k))] = 1;
  MatrixX3d normals = MatrixX3d::Zero(head.volume.V.rows(), 3);
  const RegionFaces faces = region_faces(head.volume);
  std::vector<Eigen::Index> touching;
  for (Eigen::Index f = 0; f < faces.F.rows(); ++f) {
    const bool inner_flesh = faces.inner(f) == Tissue::flesh, outer_flesh = faces.outer(f) == Tissue::flesh;
    const auto corner = faces.F.row(f);
    if (inner_flesh == outer_flesh || skin.contains(key(corner(0), corner(1), corner(2)))) continue;
    if (is_flesh(head.carrier(corner(0))) || is_flesh(head.carrier(corner(1))) || is_flesh(head.carrier(corner(2))))
      continue;
    touching.push_back(f);
    const Vector3d a = head.volume.V.row(corner(0)), b = head.volume.V.row(corner(1)), c = head.volume.V.row(corner(2));
    const Vector3d out = (outer_flesh ? 1 : -1) * (b - a).cross(c - a);
    for (int k = 0; k < 3; ++k)
      if (soft[static_cast<std::size_t>(corner(k))]) normals.row(corner(k)) += out.transpose();
  }
  return {faces.F(touching, Eigen::all), normals};
}

class Rules {
 public:
  Rules(const HeadTemplate& head, const BoneSurface& bone)
      : frame_(face_frame(head)), bone_(head.volume.V, bone.triangles), skin_(head.volume.V, head.skin_triangles) {
    for (const Muscle& muscle : head.muscles) {
      const MuscleFacts* facts = find_muscle_facts(muscle.name);
      if (muscle.ring || muscle.fibres.empty() || (facts != nullptr && (!facts->origin_on_bone || !facts->expression)))
        continue;
      Vector3d centre = Vector3d::Zero();
      for (const MatrixX3d& fibre : muscle.fibres) {
        origins_.emplace_back(fibre.row(0));
        centre += fibre.row(0).transpose() / static_cast<double>(muscle.fibres.size());
      }
      if (facts != nullptr && facts->stem == "zygomaticusMajor") zygomatic_.push_back(centre);
      if (facts != nullptr && facts->stem == "depressorAnguliOris") mandibular_.push_back(centre);
    }
    for (const char* name : {"upperTeeth", "lowerTeeth"})
      if (const Part* teeth = find_part(head, name)) teeth_.emplace_back(teeth->mesh);
  }

  /// Name of the rule for a vertex at p of the mandible (else of the skull), and what it says.
  std::pair<const char*, Hold> apply(const Vector3d& p, const Vector3d& normal, bool mandible) const {
    const Vector3d q(std::abs(p.x()), p.y(), p.z());
    if (near(origins_, p, origin_reach)) return {"muscle origin", Hold::pin};
    if (!mandible && q.x() < 0.7 * frame_.inner_canthus.x() && p.y() > frame_.nose_tip.y() &&
        p.y() < frame_.nasion.y() + 0.005 && p.z() > frame_.inner_canthus.z() - 0.005)
      return {"nose", Hold::pin};
    if ((q - frame_.inner_canthus).norm() < canthus_reach) return {"inner canthus", Hold::pin};
    for (const SurfaceQuery& teeth : teeth_)
      if (teeth.closest_point_within(p, tooth_reach)) return {"alveolar", Hold::pin};
    if (mandible && q.x() < 0.8 * frame_.mouth_corner.x() && p.z() > frame_.mouth_corner.z() - 0.02)
      return {"chin", Hold::pin};
    if (near(zygomatic_, p, ligament_reach)) return {"zygomatic", Hold::pin};
    if (near(mandibular_, p, ligament_reach)) return {"mandibular", Hold::pin};
    if (faces_bone(p, normal)) return {"deep", Hold::pin};
    if (mandible && q.x() > 0.8 * frame_.mouth_corner.x()) return {"jaw", Hold::slide};
    if (mandible) return {"elsewhere", Hold::pin};
    if (p.y() > frame_.brow) return {"scalp", Hold::slide};
    const bool above_mouth = p.y() > frame_.stomion;
    const double pupil = 0.5 * (frame_.inner_canthus.x() + frame_.outer_canthus.x());
    if (above_mouth && q.x() > 0.9 * frame_.outer_canthus.x() &&
        (p.y() > frame_.eyes || p.z() < frame_.outer_canthus.z() - 0.03))
      return {"temple", Hold::slide};
    if (above_mouth && q.x() > pupil && p.z() > frame_.outer_canthus.z() - 0.03 && p.y() < frame_.eyes - 0.008)
      return {"cheekbone", Hold::slide};
    if (above_mouth && p.z() < -0.06) return {"temple", Hold::slide};  // behind the ears: the back of the head
    return {"elsewhere", Hold::pin};
  }

 private:
  bool faces_bone(const Vector3d& p, const Vector3d& normal) const {
    constexpr double off = 0.001;  // metres: past the bone's own faces
    const auto bone = bone_.first_hit(p, normal, off, gap_reach);
    if (!bone) return false;
    const auto skin = skin_.first_hit(p, normal, 0, gap_reach);
    return !skin || bone->t < skin->t;
  }

  static bool near(const std::vector<Vector3d>& points, const Vector3d& p, double reach) {
    return std::any_of(points.begin(), points.end(),
                       [&](const Vector3d& q) { return (p - q).squaredNorm() < reach * reach; });
  }

  FaceFrame frame_;
  std::vector<Vector3d> origins_, zygomatic_, mandibular_;
  std::vector<SurfaceQuery> teeth_;
  SurfaceQuery bone_, skin_;
};

}  // namespace

Attachments find_attachments(const HeadTemplate& head, std::map<std::string, int>* count_by_rule) {
  const BoneSurface bone = bone_surface(head);
  const Rules rules(head, bone);
  std::vector<int> rows, holds;
  for (int v = 0; v < bone.normals.rows(); ++v) {
    if (bone.normals.row(v).isZero(0) || is_flesh(head.carrier(v))) continue;
    const auto [rule, hold] = rules.apply(head.volume.V.row(v), bone.normals.row(v).normalized(),
                                          head.carrier(v) == static_cast<int>(Carrier::mandible));
    rows.push_back(v);
    holds.push_back(static_cast<int>(hold));
    if (count_by_rule != nullptr) ++(*count_by_rule)[rule];
  }
  Attachments attachments;
  const auto count = static_cast<Eigen::Index>(rows.size());
  attachments.vertices = Eigen::Map<const VectorXi>(rows.data(), count);
  attachments.hold = Eigen::Map<const VectorXi>(holds.data(), count);
  attachments.normals = bone.normals(rows, Eigen::all).rowwise().normalized();
  return attachments;
}

}  // namespace phiz
