// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/builtin_head.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "phiz/anatomy/attachments.h"
#include "phiz/anatomy/builtin/bones/bones.h"
#include "phiz/anatomy/builtin/expressions/shapes.h"
#include "phiz/anatomy/builtin/flesh_thickness.h"
#include "phiz/anatomy/builtin/mouth/teeth.h"
#include "phiz/anatomy/builtin/mouth/tongue.h"
#include "phiz/anatomy/builtin/muscles.h"
#include "phiz/anatomy/builtin/skin/eye.h"
#include "phiz/anatomy/builtin/skin/people.h"
#include "phiz/anatomy/builtin/skin/surface.h"
#include "phiz/anatomy/contact_regions.h"
#include "phiz/anatomy/fibres.h"
#include "phiz/anatomy/lashes.h"
#include "phiz/anatomy/lid_muscles.h"
#include "phiz/core/error.h"
#include "phiz/geometry/tetrahedralise.h"

namespace phiz {
namespace {

/// What a size means: level of the skin, edge lengths of the simulated bones (metres).
struct SizePlan {
  int skin_level;
  double skull_edge, mandible_edge;
};
constexpr int drawn_level = 2;
constexpr double drawn_bone_edge = 0.0022;
constexpr FibreOptions muscle_voxels{0.0008, 25'000};  ///< the muscles are smooth and in one piece
constexpr std::array<SizePlan, 3> plans{{{0, 0.0112, 0.0100}, {1, 0.0105, 0.0075}, {2, 0.0055, 0.0040}}};

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

TriangleMesh make_lashes(const RefinedSkin& skin, const Proportions& p, const std::string& side) {
  const Vector3d eye = side == "left" ? p.eye_centre : p.eye_centre.cwiseProduct(Vector3d(-1, 1, 1));
  const auto sheet = [&](bool upper) {
    MatrixX3d margin =
        skin.mesh.V(skin.regions.at("loop:" + side + (upper ? "Upper" : "Lower") + "LidMargin"), Eigen::all);
    if (std::abs(margin(0, 0)) > std::abs(margin(margin.rows() - 1, 0))) margin = margin.colwise().reverse().eval();
    return std::vector<LashSheet>{lash_sheet(margin, eye, upper)};
  };
  return grow_lashes(sheet(true), sheet(false), 1);
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
  add_part(head, "leftLashes", Carrier::flesh, make_lashes(drawn_skin, p, "left"));
  add_part(head, "rightLashes", Carrier::flesh, make_lashes(drawn_skin, p, "right"));
}

}  // namespace

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
  head.name = "builtin-" + head_size_name(options.size);
  if (options.person && !options.identity) head.name += "-" + std::to_string(*options.person);
  head.provenance = "Made by phiz from parameters; free of third-party data.";

  report("bones");
  BoneOptions bone_options;
  bone_options.skull_edge = plan.skull_edge;
  bone_options.mandible_edge = plan.mandible_edge;
  bone_options.inner_clearance = 0.0019;             // of which coarse triangles may take the half
  bone_options.joint_gap += 0.18 * plan.skull_edge;  // long triangles cut corners
  const BoneSurfaces bones =
      build_bones(proportions, envelope(refine(skin, std::max(1, plan.skin_level))), simulated.mesh, bone_options);
  report("tetrahedra");
  build_volume(head, simulated.mesh, simulated.regions.at("neckCap"), bones, options.size);

  report("skin maps and parts");
  const Eigen::Index s = simulated.mesh.V.rows();
  head.skin_sampling.resize(s, drawn.mesh.V.rows());
  head.skin_sampling.reserve(VectorXi::Constant(s, 1));
  for (Eigen::Index i = 0; i < s; ++i) head.skin_sampling.insert(i, i) = 1;
  head.skin_sampling.makeCompressed();
  head.skin_interpolation = skin_interpolation_between(skin, plan.skin_level, drawn_level);
  add_parts(head, proportions, drawn);
  if (!options.person && !options.identity) head.identity = builtin_people(drawn);
  head.skin = std::move(drawn.mesh);
  head.skin_regions = std::move(drawn.regions);
  head.landmarks = skin.landmarks;
  head.jaw = jaw_joint(proportions);
  head.left_eye_centre = proportions.eye_centre;
  head.right_eye_centre = proportions.eye_centre.cwiseProduct(Vector3d(-1, 1, 1));
  head.skull_landmarks = find_skull_landmarks(head, proportions);
  assign_contacts(head, simulated.regions);

  report("muscles");
  std::vector<MuscleBundle> bundles = make_muscle_bundles(proportions);
  settle_muscles(bundles, head);
  head.muscles = make_muscles(head.volume, muscle_shapes(bundles, head), muscle_voxels);
  head.attachments = find_attachments(head);
  if (options.expressions) {
    report("expressions");
    head.expressions = make_expressions(head, proportions, bundles);
  }
  extend_muscles_to_lids(head);
  validate(head, head.name);
  return head;
}

}  // namespace phiz
