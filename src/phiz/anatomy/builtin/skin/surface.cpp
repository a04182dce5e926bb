// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/skin/surface.h"

#include <cmath>

#include "phiz/anatomy/builtin/skin/form.h"
#include "phiz/anatomy/builtin/skin/refine.h"
#include "phiz/anatomy/builtin/skin/regions.h"
#include "phiz/anatomy/builtin/skin/topology.h"
#include "phiz/anatomy/builtin/skin/uv.h"
#include "phiz/core/error.h"

namespace phiz {
namespace {

PolygonMesh empty_cage() {
  PolygonMesh cage;
  for (const auto& face : skin_topology().faces()) cage.faces.emplace_back(face.begin(), face.end());
  return cage;
}

/// The limit positions of the vertices of a level from the control vertices; the same for every person.
SparseMatrixd limit_of_level(int level) {
  PolygonMesh cage = empty_cage();
  cage.V.setZero(skin_topology().vertex_count(), 3);
  return subdivide(cage, level).limit;
}

MatrixX3d cage_vertices(const Proportions& proportions, const IdentityParameters& identity) {
  SkinForm form;
  place_sheet(form);
  place_lips(form);
  place_nostrils(form);
  place_ears(form, identity);
  fit_person(form, proportions, identity);
  place_lids(form, proportions, identity);
  place_mouth_bag(form, proportions);
  static const SparseMatrixd limit_mask = limit_of_level(0), fine_limit = limit_of_level(2);
  fair(form, limit_mask);
  clear_eyeballs(form, proportions, fine_limit);
  return form.X * 1e-3;
}

void check(const Proportions& p) {
  const bool sane =
      std::isfinite(p.vertex.sum() + p.menton.sum() + p.eye_centre.sum() + p.cheilion.sum() + p.arch.half_width) &&
      p.vertex.x() - p.menton.x() > 0.1 && p.vertex.x() - p.menton.x() < 0.5 && p.eye_radius > 0.005 &&
      p.eye_radius < 0.02;
  if (!sane)
    reject("proportions", "they make no human head", "give metres in the head frame; start from Proportions{}");
}

}  // namespace

SkinSurface build_skin(const Proportions& proportions, const IdentityParameters& identity) {
  check(proportions);
  personalise(proportions, identity);  // rejects parameters out of range
  // The texture map is that of the mean head, so that textures fit everybody.
  static const PolygonMesh mean = [] {
    PolygonMesh cage = empty_cage();
    cage.V = cage_vertices(Proportions{}, IdentityParameters{});
    unwrap_skin(cage);
    return cage;
  }();
  SkinSurface skin;
  skin.cage = mean;
  skin.cage.V = cage_vertices(proportions, identity);
  skin.regions = skin_regions();
  skin.landmarks = skin_landmarks();
  return skin;
}

}  // namespace phiz
