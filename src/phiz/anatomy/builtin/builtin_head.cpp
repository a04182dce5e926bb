// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/builtin_head.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "phiz/anatomy/builtin/bones/bones.h"
#include "phiz/anatomy/builtin/contact_regions.h"
#include "phiz/anatomy/builtin/expressions/shapes.h"
#include "phiz/anatomy/builtin/flesh_thickness.h"
#include "phiz/anatomy/builtin/mouth/teeth.h"
#include "phiz/anatomy/builtin/mouth/tongue.h"
#include "phiz/anatomy/builtin/muscles.h"
#include "phiz/anatomy/builtin/skin/eye.h"
#include "phiz/anatomy/builtin/skin/surface.h"
#include "phiz/core/error.h"
#include "phiz/geometry/tetrahedralise.h"

namespace phiz {
namespace {

/// What a size means: level of the skin, edge lengths of the simulated bones (metres), the range of soft tets to hit
/// and the bound on circumradius / shortest edge to begin with.
struct SizePlan {
  HeadSize size;
  const char* name;
  int skin_level;
  double skull_edge, mandible_edge;
  int soft_low, soft_high;
  double radius_edge_ratio;
};
constexpr int drawn_level = 2;
constexpr double drawn_bone_edge = 0.0022;
constexpr std::array<SizePlan, 3> plans{{{HeadSize::preview, "preview", 0, 0.0160, 0.0100, 6500, 9500, 2.5},
                                         {HeadSize::standard, "standard", 1, 0.0105, 0.0075, 35000, 40000, 2.5},
                                         {HeadSize::fine, "fine", 2, 0.0055, 0.0040, 150000, 260000, 1.7}}};

const SizePlan& plan_of(HeadSize size) {
  return plans[static_cast<std::size_t>(size)];
}

/// Outer skin and inner sheets of a refined skin.
BoneEnvelope envelope(const RefinedSkin& skin) {
  std::vector<char> inner(skin.mesh.V.rows(), 0);
  for (const char* name :
       {"mouthBag", "oralRoof", "oralFloor", "upperLipInner", "lowerLipInner", "leftSocket", "rightSocket",
        "leftNostril", "rightNostril", "leftUpperLid", "leftLowerLid", "rightUpperLid", "rightLowerLid"}) {
    const auto found = skin.regions.find(name);
    if (found == skin.regions.end()) continue;
    for (const int v : found->second) inner[v] = 1;
  }
  BoneEnvelope result{skin.mesh.V, {}, {}};
  result.outer.resize(skin.mesh.F.rows(), 3);
  result.inner.resize(skin.mesh.F.rows(), 3);
  Eigen::Index outer_count = 0, inner_count = 0;
  for (Eigen::Index f = 0; f < skin.mesh.F.rows(); ++f) {
    const auto triangle = skin.mesh.F.row(f);
    if (inner[triangle(0)] && inner[triangle(1)] && inner[triangle(2)])
      result.inner.row(inner_count++) = triangle;
    else
      result.outer.row(outer_count++) = triangle;
  }
  result.outer.conservativeResize(outer_count, 3);
  result.inner.conservativeResize(inner_count, 3);
  return result;
}

/// Which bone every vertex moves with: vertices of bone tets with their bone, the cap of the neck with the skull.
void assign_carriers(HeadTemplate& head, const VectorXi& neck_cap) {
  head.carrier.setZero(head.volume.V.rows());
  for (const int v : neck_cap) head.carrier(v) = static_cast<int>(Carrier::skull);
  for (Eigen::Index t = 0; t < head.volume.T.rows(); ++t) {
    const int region = head.volume.region(t);
    if (region == Tissue::flesh) continue;
    const Carrier bone = region == Tissue::skull ? Carrier::skull : Carrier::mandible;
    for (int k = 0; k < 4; ++k) head.carrier(head.volume.T(t, k)) = static_cast<int>(bone);
  }
}

/// Tets between skin and bones. Rounder tets are more tets: the bound on their shape brings the number of soft tets
/// into the plan's range.
void build_volume(HeadTemplate& head, const SizePlan& plan, const RefinedSkin& skin, const BoneSurfaces& bones) {
  const auto give = [](const TriangleMesh& bone) -> VectorXd { return VectorXd::Constant(bone.V.rows(), 0.0005); };
  const std::array<RegionSurface, 3> surfaces{
      {{"skin", {skin.mesh.V, skin.mesh.F, {}, {}}, Tissue::flesh},
       {"skull", bones.skull, Tissue::skull, false, 0, give(bones.skull)},
       {"mandible", bones.mandible, Tissue::mandible, false, 0, give(bones.mandible)}}};
  TetrahedraliseOptions options;
  options.min_dihedral = 5;
  // Little more than is needed: where lips are thin, another mesh is another way for them to settle.
  options.improve_below = 8;
  options.insert_below = 5.2;
  options.radius_edge_ratio = plan.radius_edge_ratio;
  double low = 1.2, high = 6;
  for (int attempt = 0; attempt < 5; ++attempt) {
    head.volume = tetrahedralise(surfaces, options);
    assign_carriers(head, skin.regions.at("neckCap"));
    const Eigen::Index count = soft_tets(head).size();
    if (count >= plan.soft_low && count <= plan.soft_high) return;
    (count > plan.soft_high ? low : high) = options.radius_edge_ratio;
    options.radius_edge_ratio = std::sqrt(low * high);
  }
}

JawJoint jaw_joint(const Proportions& p) {
  JawJoint joint;
  joint.centre = {0, p.condyle.y(), p.condyle.z()};
  // Opening to about 45 mm between the incisors; lateral swing; play of the condyles: sideways, down, forward.
  joint.lower << -0.02, -0.12, -0.004, -0.007, -0.002;
  joint.upper << 0.50, 0.12, 0.004, 0.002, 0.011;
  return joint;
}

void add_part(HeadTemplate& head, const char* name, Carrier carrier, TriangleMesh mesh) {
  head.parts.push_back({name, std::move(mesh), carrier, {}});
}

void add_parts(HeadTemplate& head, const Proportions& p, const RefinedSkin& drawn_skin) {
  BoneOptions options;
  options.skull_edge = options.mandible_edge = drawn_bone_edge;
  BoneSurfaces bones = build_drawn_bones(p, envelope(drawn_skin), options);
  add_part(head, "skull", Carrier::skull, std::move(bones.skull));
  add_part(head, "mandible", Carrier::mandible, std::move(bones.mandible));
  add_part(head, "upperTeeth", Carrier::skull, make_upper_teeth(p));
  add_part(head, "lowerTeeth", Carrier::mandible, make_lower_teeth(p));
  add_part(head, "upperGums", Carrier::skull, make_upper_gums(p));
  add_part(head, "lowerGums", Carrier::mandible, make_lower_gums(p));
  head.parts.push_back(make_tongue(p));
  add_part(head, "leftEye", Carrier::left_eye, build_eye(p, true).mesh);
  add_part(head, "rightEye", Carrier::right_eye, build_eye(p, false).mesh);
}

}  // namespace

HeadSize head_size(const std::string& name) {
  for (const SizePlan& plan : plans)
    if (name == plan.name) return plan.size;
  throw Error(ErrorKind::usage, "unknown head size '" + name + "'; use preview, standard or fine");
}

std::string head_size_name(HeadSize size) {
  return plan_of(size).name;
}

HeadTemplate build_builtin_head(const BuiltinOptions& options) {
  const SizePlan& plan = plan_of(options.size);
  const auto report = [&options](const char* what) {
    if (options.report) options.report(what);
  };
  IdentityParameters identity;
  if (options.identity) {
    identity = *options.identity;
  } else if (options.person) {
    identity = random_identity(*options.person);
  }
  const Proportions proportions = personalise(Proportions{}, identity);

  report("skin");
  const SkinSurface skin = build_skin(proportions, identity);
  const RefinedSkin simulated = refine(skin, plan.skin_level);
  RefinedSkin drawn = refine(skin, drawn_level);

  HeadTemplate head;
  head.name = std::string("builtin-") + plan.name;
  if (options.person && !options.identity) head.name += "-" + std::to_string(*options.person);
  head.provenance = "Made by phiz from parameters; free of third-party data.";

  report("bones");
  BoneOptions bone_options;
  bone_options.skull_edge = plan.skull_edge;
  bone_options.mandible_edge = plan.mandible_edge;
  bone_options.joint_gap += 0.18 * plan.skull_edge;  // long triangles cut corners
  const BoneSurfaces bones =
      build_bones(proportions, envelope(refine(skin, std::max(1, plan.skin_level))), simulated.mesh, bone_options);
  report("tetrahedra");
  build_volume(head, plan, simulated, bones);
  const Eigen::Index s = simulated.mesh.V.rows();
  head.skin_vertices = VectorXi::LinSpaced(s, 0, static_cast<int>(s) - 1);
  head.skin_triangles = simulated.mesh.F;

  report("skin maps and parts");
  head.skin_sampling.resize(s, drawn.mesh.V.rows());
  head.skin_sampling.reserve(VectorXi::Constant(s, 1));
  for (Eigen::Index i = 0; i < s; ++i) head.skin_sampling.insert(i, i) = 1;
  head.skin_sampling.makeCompressed();
  head.skin_interpolation = skin_interpolation_between(skin, plan.skin_level, drawn_level);
  add_parts(head, proportions, drawn);
  head.skin = std::move(drawn.mesh);
  head.skin_regions = std::move(drawn.regions);
  head.landmarks = skin.landmarks;
  head.jaw = jaw_joint(proportions);
  head.left_eye_centre = proportions.eye_centre;
  head.right_eye_centre = proportions.eye_centre.cwiseProduct(Vector3d(-1, 1, 1));
  head.skull_landmarks = find_skull_landmarks(head, proportions);
  assign_contacts(head, simulated.regions);

  report("muscles");
  std::vector<MuscleBundle> muscles = make_muscles(proportions);
  settle_muscles(muscles, head);
  assign_muscles(head, muscles);
  if (options.expressions) {
    report("expressions");
    head.expressions = make_expressions(head, proportions);
  }
  validate(head, head.name);
  return head;
}

}  // namespace phiz
