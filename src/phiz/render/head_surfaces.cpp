// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/render/head_surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "phiz/core/error.h"
#include "phiz/render/head_paint.h"
#include "phiz/render/materials.h"

namespace phiz::detail {

namespace {

bool names(const std::string& name, std::initializer_list<std::string_view> words) {
  std::string lower = name;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  return std::any_of(words.begin(), words.end(),
                     [&](std::string_view w) { return lower.find(w) != std::string::npos; });
}

bool is_bone(const Part& part) {
  return names(part.name, {"skull", "mandible", "bone"});
}
bool is_eye(const Part& part) {
  return part.carrier == Carrier::left_eye || part.carrier == Carrier::right_eye || names(part.name, {"eye"});
}

Material part_material(const Part& part, bool coloured) {
  if (is_eye(part)) return eye_material();
  if (!coloured) {
    Material m = clay_material();
    if (names(part.name, {"teeth"})) m.albedo = m.albedo * 1.25;
    return m;
  }
  if (names(part.name, {"teeth", "tooth"})) return enamel_material();
  if (names(part.name, {"gum", "tongue", "palate"})) return gum_material();
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

/// Fibres as thin tubes.
Surface muscle_surface(const HeadTemplate& head) {
  constexpr int sides = 6;
  constexpr double radius = 0.00075;
  Surface s;
  s.name = "muscles";
  s.material = muscle_material();
  std::vector<Vector3d> points;
  std::vector<Eigen::Vector3i> triangles;
  for (const Muscle& muscle : head.muscles) {
    for (const MatrixX3d& fibre : muscle.fibres) {
      if (fibre.rows() < 2) continue;
      Vector3d normal = Vector3d::Zero();
      const int first = static_cast<int>(points.size());
      for (Eigen::Index i = 0; i < fibre.rows(); ++i) {
        const Vector3d along =
            (fibre.row(std::min(i + 1, fibre.rows() - 1)) - fibre.row(std::max<Eigen::Index>(i - 1, 0)))
                .transpose()
                .stableNormalized();
        normal = normal.norm() < 0.5 ? along.unitOrthogonal()
                                     : Vector3d((normal - along * along.dot(normal)).stableNormalized());
        const Vector3d side = along.cross(normal);
        for (int k = 0; k < sides; ++k) {
          const double a = 2 * M_PI * k / sides;
          points.emplace_back(fibre.row(i).transpose() + radius * (std::cos(a) * normal + std::sin(a) * side));
        }
      }
      for (int i = 0; i + 1 < fibre.rows(); ++i) {
        for (int k = 0; k < sides; ++k) {
          const int a = first + i * sides + k, b = first + i * sides + (k + 1) % sides;
          triangles.emplace_back(a, b, b + sides);
          triangles.emplace_back(a, b + sides, a + sides);
        }
      }
    }
  }
  s.mesh.V.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) s.mesh.V.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
  s.mesh.F.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t i = 0; i < triangles.size(); ++i)
    s.mesh.F.row(static_cast<Eigen::Index>(i)) = triangles[i].transpose();
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
  if (options.style == HeadStyle::anatomy) {
    s.colour_at = nullptr;
    s.material.opacity = 0.16;
    s.material.grain = 0;
  }
  return s;
}

Vector3d tissue_colour(int tissue) {
  switch (tissue) {
    case Tissue::skull:
      return {0.78, 0.70, 0.55};
    case Tissue::mandible:
      return {0.62, 0.66, 0.52};
    default:
      return {0.60, 0.22, 0.18};
  }
}

/// The cap of a part lies a hair in front of the tissue's section, so that it wins where both show.
void add_cut_part(Scene& scene, const Surface& part, const CutPlane& plane, double lift) {
  scene.surfaces.push_back(cut_surface(part, plane));
  Surface face = cap(part, plane);
  if (face.mesh.F.rows() == 0) return;
  face.transform = Eigen::Translation3d(plane.normal.normalized() * lift) * face.transform;
  face.material.unlit = 0.35;
  face.material.roughness = 0.7;
  face.colour_at = nullptr;
  scene.surfaces.push_back(std::move(face));
}

void add_cutaway(Scene& scene, const PosedHead& posed, const HeadViewOptions& options) {
  const CutPlane& plane = options.plane;
  const Surface skin = skin_surface(posed, options);
  scene.surfaces.push_back(cut_surface(skin, plane));
  const bool tissue = posed.head != nullptr && posed.volume_now.rows() > 0;
  if (tissue) {
    TetMesh volume = posed.head->volume;
    volume.V = posed.volume_now;
    std::map<int, Vector3d> colours;
    for (const int t : {Tissue::flesh, Tissue::skull, Tissue::mandible}) colours[t] = tissue_colour(t);
    scene.surfaces.push_back(cross_section(volume, plane, colours, options.cut_tets));
  } else {
    Surface face = cap(skin, plane);
    face.colour.resize(0, 3);
    face.material.albedo = tissue_colour(Tissue::flesh);
    face.material.grain = 0;
    face.material.unlit = 0.35;
    scene.surfaces.push_back(std::move(face));
  }
  for (std::size_t i = 0; i < posed.parts->size(); ++i) {
    const Part& part = (*posed.parts)[i];
    Surface s = part_surface(posed, i, true);
    if (is_bone(part)) {
      s.material.albedo = tissue_colour(part.carrier == Carrier::mandible ? int{Tissue::mandible} : int{Tissue::skull});
    }
    const double lift = is_bone(part) ? 2e-5 : names(part.name, {"teeth", "tooth"}) ? 8e-5 : 5e-5;
    add_cut_part(scene, s, plane, lift);
  }
}

}  // namespace

Scene build_scene(const PosedHead& posed, const HeadViewOptions& options) {
  Scene scene;
  if (options.style == HeadStyle::cutaway) {
    add_cutaway(scene, posed, options);
    return scene;
  }
  const bool inside = options.style == HeadStyle::anatomy || options.style == HeadStyle::bones;
  const bool coloured = inside || options.style == HeadStyle::skin;
  if (options.style != HeadStyle::bones) scene.surfaces.push_back(skin_surface(posed, options));
  for (std::size_t i = 0; i < posed.parts->size(); ++i)
    if (inside || !is_bone((*posed.parts)[i])) scene.surfaces.push_back(part_surface(posed, i, coloured));
  if (options.style == HeadStyle::anatomy && posed.head != nullptr) {
    Surface muscles = muscle_surface(*posed.head);
    if (muscles.mesh.F.rows() > 0) scene.surfaces.push_back(std::move(muscles));
  }
  return scene;
}

}  // namespace phiz::detail
