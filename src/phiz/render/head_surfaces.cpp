// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/render/head_surfaces.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/geometry/spatial_query.h"
#include "phiz/geometry/surface.h"
#include "phiz/render/head_paint.h"
#include "phiz/render/materials.h"
#include "phiz/render/muscle_surfaces.h"
#include "phiz/render/palette.h"

namespace phiz::detail {

bool has_name(const Part& part, std::initializer_list<std::string_view> words) {
  std::string lower = part.name;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  return std::any_of(words.begin(), words.end(),
                     [&](std::string_view w) { return lower.find(w) != std::string::npos; });
}

bool is_bone(const Part& part) {
  return has_name(part, {"skull", "mandible", "vertebra", "bone"});
}
bool is_eye(const Part& part) {
  return part.carrier == Carrier::left_eye || part.carrier == Carrier::right_eye || has_name(part, {"eye"});
}

namespace {

Material part_material(const Part& part, bool coloured) {
  if (is_eye(part)) return eye_material();
  if (part.carrier == Carrier::flesh) return hair_material();
  if (!coloured) {
    Material m = clay_material();
    if (has_name(part, {"teeth"})) m.albedo = m.albedo * 1.25;
    return m;
  }
  if (has_name(part, {"teeth", "tooth"})) return enamel_material();
  if (has_name(part, {"gum", "tongue", "palate"})) return gum_material();
  return bone_material();
}

/// Diagonals of quads that were split into consecutive triangles are left out, if nearly all triangles pair up so.
std::vector<std::uint8_t> quad_edges(const MatrixX3i& F) {
  std::vector<std::uint8_t> edges(static_cast<std::size_t>(F.rows()), 7);
  Eigen::Index paired = 0;
  for (Eigen::Index f = 0; f + 1 < F.rows();) {
    int shared = 0, here = 0, there = 0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        if (F(f, i) == F(f + 1, (j + 1) % 3) && F(f, (i + 1) % 3) == F(f + 1, j)) {
          ++shared;
          here = i;
          there = j;
        }
    if (shared != 1) {
      ++f;
      continue;
    }
    edges[f] = static_cast<std::uint8_t>(edges[f] & ~(1U << here));
    edges[f + 1] = static_cast<std::uint8_t>(edges[f + 1] & ~(1U << there));
    paired += 2;
    f += 2;
  }
  if (paired < 0.9 * static_cast<double>(F.rows())) std::fill(edges.begin(), edges.end(), std::uint8_t{7});
  return edges;
}

}  // namespace

Surface part_surface(const PosedHead& posed, std::size_t i, bool coloured) {
  const Part& part = (*posed.parts)[i];
  Surface s;
  s.name = part.name;
  s.mesh.V = posed.part_now.size() > i && posed.part_now[i].rows() > 0 ? posed.part_now[i] : part.mesh.V;
  s.mesh.F = part.mesh.F;
  s.rest = part.mesh.V;
  s.transform = posed.motion[i];
  s.material = part_material(part, coloured);
  if (is_eye(part)) {
    const Vector3d middle = (part.mesh.V.colwise().minCoeff() + part.mesh.V.colwise().maxCoeff()).transpose() / 2;
    const Vector3d& left = posed.left_eye;
    const Vector3d& right = posed.right_eye;
    const Vector3d centre = (middle - left).norm() < (middle - right).norm() ? left : right;
    const double radius = part.mesh.V.rows() > 0 ? (part.mesh.V.col(1).array() - centre.y()).abs().maxCoeff() : 0;
    if (radius > 0) s.colour_at = eye_pattern(centre, radius);
  }
  return s;
}

Surface skin_surface(const PosedHead& posed, const HeadViewOptions& options) {
  Surface s;
  s.name = "skin";
  s.mesh.V = posed.skin_now;
  s.mesh.F = posed.skin->F;
  s.rest = posed.skin->V;
  switch (options.style) {
    case HeadStyle::skin:
    case HeadStyle::anatomy:
    case HeadStyle::cutaway:
    case HeadStyle::muscles:
    case HeadStyle::fibres:
    case HeadStyle::attachments:
      s.material = skin_material();
      if (posed.head != nullptr) {
        s.colour = paint_skin(*posed.skin, posed.head->skin_regions);
        s.colour_at = hair_pattern(*posed.head);
      }
      break;
    case HeadStyle::heat:
      paint_heat(s, options.values, options.scale);
      break;
    case HeadStyle::wireframe:
      s.material = clay_material();
      s.wireframe.shown = true;
      s.wireframe.edges = quad_edges(s.mesh.F);
      break;
    default:
      s.material = clay_material();
  }
  return s;
}

namespace {

/// Skin that all behind it shows through.
Surface veil(Surface skin, double opacity) {
  skin.colour_at = nullptr;
  skin.material.opacity = opacity;
  skin.material.grain = 0;
  return skin;
}

/// The kept part of the skin with its thickness at the rim and what lies under it on the inside.
void add_peeled_skin(Scene& scene, const Surface& skin, const CutPlane& plane) {
  constexpr double thickness = 0.0018, start = 1e-5;  // metres
  Surface inside;
  inside.name = "under the skin";
  inside.mesh = skin.mesh;
  const MatrixX3d normals = vertex_normals(skin.mesh.V, skin.mesh.F);
  const SurfaceQuery query(skin.mesh);
  VectorXd depth(skin.mesh.V.rows());
  parallel_for(skin.mesh.V.rows(), [&](std::ptrdiff_t v) {
    const Vector3d p = skin.mesh.V.row(v), in = -normals.row(v).transpose();
    const auto opposite = query.first_hit(p + start * in, in, 0, 4 * thickness);  // thin lobes and lids have less
    depth[v] = opposite ? std::min(thickness, 0.35 * opposite->t) : thickness;
    inside.mesh.V.row(v) += depth[v] * in.transpose();
  });
  inside.mesh.F.col(1).swap(inside.mesh.F.col(2));
  inside.material = section_material();
  inside.material.albedo = tissue_colour::flesh;
  inside.material.unlit = 0;
  Surface rim = skin;
  const Eigen::Index n = skin.mesh.V.rows(), faces = skin.mesh.F.rows();
  rim.mesh.V.conservativeResize(2 * n, 3);
  rim.mesh.V.bottomRows(n) = inside.mesh.V;
  rim.mesh.F.conservativeResize(2 * faces, 3);
  rim.mesh.F.bottomRows(faces) = (inside.mesh.F.array() + static_cast<int>(n)).matrix();
  rim = cap(rim, plane);
  // Where skin lies against skin, nothing is under it that could be seen.
  std::vector<int> apart;
  for (int f = 0; f < faces; ++f)
    if (depth(skin.mesh.F.row(f)).minCoeff() > 0.2 * thickness) apart.push_back(f);
  inside.mesh.F = MatrixX3i(inside.mesh.F(apart, Eigen::all));
  rim.material = section_material();
  rim.material.albedo = tissue_colour::skin;
  for (const Surface& s : {cut_surface(skin, plane), cut_surface(inside, plane), rim})
    if (s.mesh.F.rows() > 0) scene.surfaces.push_back(s);
}

const HeadTemplate& anatomy_of(const PosedHead& posed) {
  if (posed.head == nullptr)
    throw Error(ErrorKind::usage,
                "a take holds no muscles, attachments or contact regions; give its head with --model");
  return *posed.head;
}

}  // namespace

Scene build_scene(const PosedHead& posed, const HeadViewOptions& options) {
  Scene scene;
  const HeadStyle style = options.style;
  if (style == HeadStyle::cutaway) {
    add_cutaway(scene, posed, options);
    return scene;
  }
  const bool layers = style == HeadStyle::muscles || style == HeadStyle::fibres || style == HeadStyle::attachments;
  const bool maps = style == HeadStyle::attachments || style == HeadStyle::contacts;
  const bool inside = layers || style == HeadStyle::anatomy || style == HeadStyle::bones;
  const bool coloured = inside || style == HeadStyle::skin || style == HeadStyle::contacts;
  if (layers || maps) anatomy_of(posed);

  const Surface skin = skin_surface(posed, options);
  if (layers && options.peel) add_peeled_skin(scene, skin, *options.peel);
  if (style == HeadStyle::anatomy || (style == HeadStyle::fibres && !options.peel))
    scene.surfaces.push_back(veil(skin, style == HeadStyle::fibres ? 0.09 : 0.16));
  if (!inside && !maps) scene.surfaces.push_back(skin);

  for (std::size_t i = 0; i < posed.parts->size(); ++i) {
    const bool bone = is_bone((*posed.parts)[i]);
    if (bone && (!inside || maps)) continue;
    if ((*posed.parts)[i].carrier == Carrier::flesh && (inside || maps)) continue;
    Surface part = part_surface(posed, i, coloured);
    if (bone && style == HeadStyle::fibres) part.material.albedo *= 0.45;  // white fibres stand out
    scene.surfaces.push_back(std::move(part));
  }
  if (style == HeadStyle::muscles || (style == HeadStyle::anatomy && posed.head != nullptr))
    add_muscles(scene, posed, options);
  if (style == HeadStyle::fibres) add_fibres(scene, posed, options);
  if (style == HeadStyle::attachments) add_attachments(scene, posed);
  if (style == HeadStyle::contacts) add_contacts(scene, posed, options);
  return scene;
}

}  // namespace phiz::detail
