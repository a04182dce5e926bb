// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/open/open_head.h"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "phiz/anatomy/attachments.h"
#include "phiz/anatomy/bones/implicit.h"
#include "phiz/anatomy/builtin/muscles.h"
#include "phiz/anatomy/contact_regions.h"
#include "phiz/anatomy/fibres.h"
#include "phiz/anatomy/lid_muscles.h"
#include "phiz/anatomy/open/face_guide.h"
#include "phiz/anatomy/open/face_kit_layout.h"
#include "phiz/anatomy/open/face_kit_skin.h"
#include "phiz/anatomy/open/jaw_of_mandible.h"
#include "phiz/anatomy/open/kit_expressions.h"
#include "phiz/anatomy/open/kit_identity.h"
#include "phiz/anatomy/open/kit_parts.h"
#include "phiz/anatomy/open/part_muscles.h"
#include "phiz/anatomy/open/registration.h"
#include "phiz/anatomy/skin_maps.h"
#include "phiz/geometry/remesh.h"
#include "phiz/geometry/solidify.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/topology.h"

namespace phiz {

namespace {

/// Vertices of the simulation skin and edge lengths of the simulated bones (metres).
struct SizePlan {
  int skin_vertices;
  double skull_edge, mandible_edge;
};
constexpr std::array<SizePlan, 3> size_plans{{{1250, 0.0150, 0.0110}, {5900, 0.0090, 0.0060}, {12500, 0.0050, 0.0036}}};

/// Outer skin and inner sheets of a skin.
BoneEnvelope envelope(const TriangleMesh& skin, const SkinRegions& regions) {
  std::vector<char> inner(static_cast<std::size_t>(skin.V.rows()), 0);
  for (const char* name : {"mouthBag", "leftSocket", "rightSocket"})
    for (const int v : regions.at(name)) inner[static_cast<std::size_t>(v)] = 1;
  std::vector<int> in, out;
  for (int f = 0; f < skin.F.rows(); ++f) {
    const auto is_inner = [&](int k) { return inner[static_cast<std::size_t>(skin.F(f, k))] != 0; };
    (is_inner(0) && is_inner(1) && is_inner(2) ? in : out).push_back(f);
  }
  return {skin.V, skin.F(out, Eigen::all), skin.F(in, Eigen::all)};
}

/// Distance to the surface of a solid, by way of voxels, with gaps narrower than twice `gap` sealed.
ScalarField distance_field(const TriangleMesh& solid, double gap) {
  constexpr double spacing = 0.001, margin = 0.03;
  const VoxelGrid grid =
      grid_round({solid.V.colwise().minCoeff().transpose(), solid.V.colwise().maxCoeff().transpose()}, spacing, margin);
  VoxelFlags cells(static_cast<std::size_t>(grid.count()), 0);
  fill_inside(grid, solid, cells);
  seal_gaps(grid, gap, cells);
  return [field = std::make_shared<VoxelField>(signed_distance_field(grid, cells))](const Vector3d& p) {
    return (*field)(p);
  };
}

/// The regions of the drawn skin on the simulation skin: vertices that are drawn mostly from theirs.
SkinRegions simulated_regions(const FaceKitSkin& skin, const SparseMatrixd& sampling) {
  SkinRegions regions;
  for (const auto& [name, rows] : skin.regions) {
    VectorXd member = VectorXd::Zero(skin.mesh.V.rows());
    for (const int v : rows) member[v] = 1;
    const VectorXd share = sampling * member;
    std::vector<int> found;
    for (int v = 0; v < share.size(); ++v)
      if (share[v] > 0.5) found.push_back(v);
    regions[name] = Eigen::Map<VectorXi>(found.data(), static_cast<Eigen::Index>(found.size()));
  }
  return regions;
}

/// All bones of a kind, as they are, in the face's frame.
TriangleMesh drawn_bone(const BodyParts& parts, BodyPartKind kind, const SpaceMap& map, int triangles) {
  std::vector<TriangleMesh> meshes;
  Eigen::Index total = 0;
  for (const auto* list : {&needed_body_parts(), &optional_body_parts()})
    for (const BodyPartName& part : *list)
      if (part.kind == kind && parts.meshes.contains(part.fma)) meshes.push_back(parts.at(part.fma));
  for (const TriangleMesh& mesh : meshes) total += mesh.F.rows();
  for (TriangleMesh& mesh : meshes) {
    if (is_edge_manifold(mesh.F) && is_vertex_manifold(mesh.F) && is_oriented(mesh.F))
      mesh = decimate(mesh, std::max<int>(200, static_cast<int>(triangles * mesh.F.rows() / total)));
    mesh.V = map(mesh.V);
  }
  return joined(meshes);
}

void translate(MuscleShape& shape, const Vector3d& by) {
  for (MatrixX3d* points : {&shape.surface.V, &shape.origin, &shape.insertion}) points->rowwise() += by.transpose();
  shape.ring_centre += by;
}

/// The fan of the temporalis, which BodyParts3D lacks: from an arc on the temple to the tip of the coronoid process.
MuscleBundle temporalis(const Proportions& p, const MatrixX3d& mandible, double side) {
  constexpr int fibres = 15, points = 13;
  MuscleBundle bundle;
  bundle.radius = 0.0032;
  bundle.origin_depth = 0.3;
  bundle.insertion_depth = 0.3;
  // The coronoid process: the highest point of the mandible in front of the condyle.
  constexpr double before_condyle = 0.014;
  Vector3d tip(0, -1, 0);
  for (Eigen::Index v = 0; v < mandible.rows(); ++v)
    if (side * mandible(v, 0) > 0 && mandible(v, 2) > before_condyle && mandible(v, 1) > tip.y()) tip = mandible.row(v);
  const Vector3d front(side * 0.90 * p.exocanthion.x() + side * 0.012, p.eye_centre.y() + 0.012,
                       p.exocanthion.z() - 0.014);
  const Vector3d top(side * 0.88 * p.euryon.x(), p.eye_centre.y() + 0.062, 0.35 * p.exocanthion.z());
  const Vector3d back(side * p.euryon.x(), p.eye_centre.y() + 0.026, p.tragion.z() - 0.030);
  for (int f = 0; f < fibres; ++f) {
    const double t = f / (fibres - 1.0);
    const Vector3d origin =
        (1 - t) * (1 - t) * front + 2 * t * (1 - t) * (2 * top - 0.5 * (front + back)) + t * t * back;
    const Vector3d end = tip + Vector3d(0, -0.004, 0.004 - 0.010 * t);
    MatrixX3d fibre(points, 3);
    for (int i = 0; i < points; ++i) fibre.row(i) = origin + (end - origin) * i / (points - 1.0);
    bundle.fibres.push_back(fibre);
  }
  return bundle;
}

/// What BodyParts3D lacks (temporalis), or has as threads only (depressor septi, levator anguli oris), is drawn: the
/// latter as in the built-in head.
void add_drawn_muscles(std::vector<MuscleShape>& shapes, const HeadTemplate& head, const Proportions& proportions,
                       const MatrixX3d& mandible) {
  std::vector<MuscleBundle> bundles = make_muscle_bundles(proportions);
  std::erase_if(bundles, [](const MuscleBundle& bundle) {
    return bundle.name != "depressorSepti" && !bundle.name.starts_with("levatorAnguliOris");
  });
  for (const double side : {1.0, -1.0}) {
    bundles.push_back(temporalis(proportions, mandible, side));
    bundles.back().name = side > 0 ? "temporalis left" : "temporalis right";
  }
  settle_muscles(bundles, head);
  for (MuscleShape& shape : muscle_shapes(bundles, head)) {
    if (shape.name == "temporalis left") shape.name = "temporalisLeft";
    if (shape.name == "temporalis right") shape.name = "temporalisRight";
    shapes.push_back(std::move(shape));
  }
}

}  // namespace

HeadTemplate build_open_head(const FaceKit& kit, const BodyParts& parts, const OpenHeadOptions& options) {
  const SizePlan& plan = size_plans[static_cast<std::size_t>(options.size)];
  const auto report = [&options](const char* what) {
    if (options.report) options.report(what);
  };
  report("measure the face");
  const FaceGuide guide = measure_face(kit);
  report("solid bones");
  const BoneSolids solids = solid_bones(parts);
  report("registration");
  const SpaceMap map = register_anatomy(parts, solids, guide);

  report("skin");
  const FaceKitSkin skin = make_face_kit_skin(kit);
  const TriangleMesh simulated = simulation_skin(skin, plan.skin_vertices);

  HeadTemplate head;
  head.name = "open-" + head_size_name(options.size);
  head.provenance =
      "Skin, mouth, eyes, expressions and identities: ICT Face Model Light, (c) 2020 USC Institute for Creative "
      "Technologies, MIT licence. Bones and muscles: BodyParts3D, (c) The Database Center for Life Science licensed "
      "under CC Attribution 4.0 International. Registered and meshed by phiz.";

  report("bones");
  TriangleMesh skull = solids.skull, mandible = solids.mandible;
  skull.V = map(skull.V);
  mandible.V = map(mandible.V);
  constexpr double sealed = 0.3;  // of the edge length: what long triangles cannot follow
  const ScalarField cranium = distance_field(skull, sealed * plan.skull_edge);
  std::vector<Vector3d> column;  // from the atlas downwards
  constexpr int atlas = 12519, seventh_cervical = 12525;
  for (int fma = atlas; fma <= seventh_cervical; ++fma)
    if (const auto found = parts.meshes.find(fma); found != parts.meshes.end())
      column.emplace_back(map(found->second.V.colwise().mean()).row(0));
  constexpr double column_radius = 0.013, seam = 0.006;
  const BoneShape skull_shape{
      [=](const Vector3d& p) {
        double f = cranium(p);
        for (std::size_t i = 0; i + 1 < column.size(); ++i)
          f = implicit::blend(f, implicit::capsule(p, column[i], column[i + 1], column_radius, column_radius), seam);
        return f;
      },
      {}};
  const BoneShape mandible_shape{distance_field(mandible, sealed * plan.mandible_edge), {}};
  BoneOptions bone_options;
  bone_options.skull_edge = plan.skull_edge;
  bone_options.mandible_edge = plan.mandible_edge;
  bone_options.inner_clearance = 0.0019;             // of which coarse triangles may take the half
  bone_options.joint_gap += 0.18 * plan.skull_edge;  // long triangles cut corners
  head.skin_sampling = sample_skin(skin.mesh, simulated.V);
  const SkinRegions regions = simulated_regions(skin, head.skin_sampling);
  const BoneSurfaces bones = settle_bones(
      clip_bones(skull_shape, mandible_shape, envelope(simulated, regions), bone_options), simulated, bone_options);
  report("tetrahedra");
  build_volume(head, simulated, regions.at("shoulders"), bones, options.size);

  report("skin maps and parts");
  head.skin_interpolation = smooth_interpolation(skin.mesh, head.skin_sampling);
  head.skin = skin.mesh;
  head.skin_regions = skin.regions;
  head.parts.push_back({"skull", drawn_bone(parts, BodyPartKind::skull, map, 60000), Carrier::skull, {}});
  head.parts.push_back({"vertebrae", drawn_bone(parts, BodyPartKind::vertebra, map, 12000), Carrier::skull, {}});
  head.parts.push_back({"mandible", drawn_bone(parts, BodyPartKind::mandible, map, 12000), Carrier::mandible, {}});
  for (Part& part : kit_parts(kit)) head.parts.push_back(std::move(part));
  for (std::size_t i = 0; i < face_kit::landmarks.size(); ++i)
    head.landmarks.push_back({std::to_string(i), face_kit::landmarks[i]});
  head.jaw = joint_of(condyle_centres(mandible.V));
  head.left_eye_centre = guide.left_eye;
  head.right_eye_centre = guide.right_eye;
  assign_contacts(head, regions);

  report("expressions");
  head.expressions = kit_expressions(kit, skin, head.jaw);
  report("people");
  head.identity = kit_identity(kit, skin);

  const Vector3d to_condyles = -head.jaw.centre;
  translate(head, to_condyles);
  const Proportions proportions = translated(guide.proportions, to_condyles);
  head.skull_landmarks = find_skull_landmarks(head, proportions);
  report("muscles");
  std::vector<MuscleShape> shapes =
      part_muscles(parts, map, guide, skin, std::array{skull, mandible, bones.skull, bones.mandible});
  for (MuscleShape& shape : shapes) translate(shape, to_condyles);
  add_drawn_muscles(shapes, head, proportions, mandible.V.rowwise() + to_condyles.transpose());
  head.muscles = make_muscles(head.volume, shapes, {.widest_gap = 0.008});
  extend_muscles_to_lids(head);
  head.attachments = find_attachments(head);
  validate(head, head.name);
  return head;
}

}  // namespace phiz
