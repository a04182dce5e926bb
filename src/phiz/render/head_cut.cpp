// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <memory>
#include <utility>

#include "phiz/geometry/spatial_query.h"
#include "phiz/geometry/topology.h"
#include "phiz/render/head_paint.h"
#include "phiz/render/materials.h"
#include "phiz/render/muscle_surfaces.h"
#include "phiz/render/palette.h"

namespace phiz::detail {

namespace {

// Sections lie a hair in front of each other, so that the right one wins where two show.
constexpr double rigid_lift = 0.5e-5, fraction_lift = 1e-5, muscle_lift = 2e-5, next_muscle = 2e-7, bone_lift = 5e-5,
                 soft_lift = 6e-5, tooth_lift = 8e-5;

/// A flat surface in the cut with its tissue's plain colour, moved towards the viewer by `lift`.
Surface flat_section(Surface section, const Vector3d& colour, const CutPlane& plane, double lift) {
  section.transform = Eigen::Translation3d(plane.normal.normalized() * lift) * section.transform;
  section.colour.resize(0, 3);
  section.colour_at = nullptr;
  section.material = section_material();
  section.material.albedo = colour;
  section.outline = 0.45;
  return section;
}

Vector3d section_colour(const Part& part) {
  if (is_eye(part)) return tissue_colour::eye;
  if (has_name(part, {"teeth", "tooth"})) return tissue_colour::tooth;
  if (has_name(part, {"tongue"})) return tissue_colour::tongue;
  if (has_name(part, {"gum", "palate"})) return tissue_colour::gum;
  return part.carrier == Carrier::mandible ? tissue_colour::mandible : tissue_colour::skull;
}

/// The skin's thickness at the rim of the cut, in the colours of the skin there, over flesh.
std::function<Vector3d(const Vector3d&)> rim_of_skin(const PosedHead& posed) {
  constexpr double thickness = 0.0016, blur = 0.00012;  // metres; of facial skin
  const auto query = std::make_shared<SurfaceQuery>(posed.skin_now, posed.skin->F);
  const auto colour =
      std::make_shared<MatrixX3d>(posed.head != nullptr ? paint_skin(*posed.skin, posed.head->skin_regions)
                                                        : MatrixX3d::Ones(posed.skin->V.rows(), 3));
  return [query, colour, F = &posed.skin->F](const Vector3d& p) -> Vector3d {
    const auto nearest = query->closest_point_within(p, thickness + blur);
    if (!nearest) return tissue_colour::flesh;
    Vector3d tint = Vector3d::Zero();
    for (int k = 0; k < 3; ++k) tint += nearest->barycentric[k] * colour->row((*F)(nearest->triangle, k)).transpose();
    const Vector3d skin = tissue_colour::skin.cwiseProduct(tint);
    const double t = std::clamp((std::sqrt(nearest->squared_distance) - thickness + blur) / (2 * blur), 0.0, 1.0);
    return skin + t * (tissue_colour::flesh - skin);
  };
}

/// The share of every tet that the muscles fill, of those that are shown; `with_surface`: of all, or of those without
/// a surface only.
VectorXd filled_share(const PosedHead& posed, const HeadViewOptions& options, bool with_surface) {
  VectorXd share = VectorXd::Zero(posed.head->volume.T.rows());
  for (const ShownMuscle& shown : shown_muscles(*posed.head, options)) {
    const Muscle& muscle = posed.head->muscles[shown.row];
    if (!with_surface && muscle.surface.F.rows() > 0) continue;
    for (Eigen::Index i = 0; i < muscle.tets.size(); ++i) share[muscle.tets[i]] += muscle.fraction[i];
  }
  return share.cwiseMin(1);
}

MatrixX3d tet_colours(const TetMesh& volume, const VectorXd& share) {
  MatrixX3d colours(volume.T.rows(), 3);
  for (Eigen::Index t = 0; t < colours.rows(); ++t) {
    const int tissue = volume.region.size() == volume.T.rows() ? volume.region[t] : int{Tissue::flesh};
    Vector3d colour = tissue_colour::flesh + share[t] * (tissue_colour::muscle - tissue_colour::flesh);
    if (tissue == Tissue::skull) colour = tissue_colour::skull;
    if (tissue == Tissue::mandible) colour = tissue_colour::mandible;
    colours.row(t) = colour.transpose();
  }
  return colours;
}

/// The section of some of the tets. `colours`: a row for each of them.
void add_tets(Scene& scene, const PosedHead& posed, const std::vector<int>& tets, const MatrixX3d& colours,
              const CutPlane& plane, double lift) {
  TetMesh part;
  part.V = posed.volume_now;
  part.T = posed.head->volume.T(tets, Eigen::all);
  Surface section = cross_section(part, plane, colours);
  if (section.mesh.F.rows() == 0) return;
  section.transform = Eigen::Translation3d(plane.normal.normalized() * lift) * section.transform;
  scene.surfaces.push_back(std::move(section));
}

/// What moves with the bones: it shows where the bones as drawn are hollow.
void add_rigid_tets(Scene& scene, const PosedHead& posed, const CutPlane& plane) {
  std::vector<int> rigid;
  const VectorXi& region = posed.head->volume.region;
  for (int t = 0; t < region.size(); ++t)
    if (region[t] != Tissue::flesh) rigid.push_back(t);
  add_tets(scene, posed, rigid, tissue_colour::cavity.transpose().replicate(rigid.size(), 1), plane, rigid_lift);
}

/// The tets in which muscles without a surface lie.
void add_fractions(Scene& scene, const PosedHead& posed, const HeadViewOptions& options) {
  const VectorXd share = filled_share(posed, options, false);
  std::vector<int> filled;
  for (int t = 0; t < share.size(); ++t)
    if (share[t] > 0.03) filled.push_back(t);
  const MatrixX3d colours = tet_colours(posed.head->volume, share)(filled, Eigen::all);
  add_tets(scene, posed, filled, colours, options.plane, fraction_lift);
}

void add_section(Scene& scene, const Surface& closed, const Vector3d& colour, const CutPlane& plane, double lift) {
  Surface section = solid_cap(closed, plane);
  if (section.mesh.F.rows() > 0) scene.surfaces.push_back(flat_section(std::move(section), colour, plane, lift));
}

/// Flesh, skin and muscles in the cut.
void add_soft_sections(Scene& scene, const PosedHead& posed, const HeadViewOptions& options, const Surface& skin) {
  const CutPlane& plane = options.plane;
  const bool tissue = posed.head != nullptr && posed.volume_now.rows() > 0 && posed.head->volume.T.rows() > 0;
  if (tissue && (options.cut_tets || !is_closed(skin.mesh.F))) {
    TetMesh volume = posed.head->volume;
    volume.V = posed.volume_now;
    const VectorXd share = filled_share(posed, options, options.cut_tets);
    scene.surfaces.push_back(cross_section(volume, plane, tet_colours(volume, share), options.cut_tets));
  } else {
    Surface flesh = cap(skin, plane);
    flesh = flat_section(std::move(flesh), Vector3d::Ones(), plane, 0);
    flesh.colour_at = rim_of_skin(posed);
    flesh.outline = 0;
    if (flesh.mesh.F.rows() > 0) scene.surfaces.push_back(std::move(flesh));
    if (tissue) {
      add_rigid_tets(scene, posed, plane);
      add_fractions(scene, posed, options);
    }
  }
  if (!tissue || options.cut_tets) return;
  const TissueMotion motion(posed);
  for (const ShownMuscle& shown : shown_muscles(*posed.head, options)) {
    if (posed.head->muscles[shown.row].surface.F.rows() == 0) continue;
    add_section(scene, muscle_belly(posed, motion, shown, options), colour_of(shown, options), plane,
                muscle_lift + next_muscle * shown.row);
  }
}

}  // namespace

void add_cutaway(Scene& scene, const PosedHead& posed, const HeadViewOptions& options) {
  const CutPlane& plane = options.plane;
  const Surface skin = skin_surface(posed, options);
  scene.surfaces.push_back(cut_surface(skin, plane));
  add_soft_sections(scene, posed, options, skin);
  for (std::size_t i = 0; i < posed.parts->size(); ++i) {
    const Part& part = (*posed.parts)[i];
    const Surface s = part_surface(posed, i, true);
    scene.surfaces.push_back(cut_surface(s, plane));
    if (part.carrier == Carrier::flesh) continue;
    const double lift = is_bone(part) ? bone_lift : has_name(part, {"teeth", "tooth"}) ? tooth_lift : soft_lift;
    add_section(scene, s, section_colour(part), plane, lift);
  }
}

}  // namespace phiz::detail
