// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/head_volume.h"

#include <array>
#include <cmath>
#include <cstddef>

#include "phiz/core/error.h"
#include "phiz/geometry/tetrahedralise.h"

namespace phiz {
namespace {

/// The range of soft tets to hit and the bound on circumradius / shortest edge to begin with.
struct SizePlan {
  HeadSize size;
  const char* name;
  int soft_low, soft_high;
  double radius_edge_ratio;
};
constexpr std::array<SizePlan, 3> plans{{{HeadSize::preview, "preview", 6500, 9500, 2.5},
                                         {HeadSize::standard, "standard", 35000, 40000, 2.5},
                                         {HeadSize::fine, "fine", 150000, 260000, 1.7}}};

/// Which bone every vertex moves with: vertices of bone tets with their bone, held skin with the skull.
void assign_carriers(HeadTemplate& head, const VectorXi& held) {
  head.carrier.setZero(head.volume.V.rows());
  for (const int v : held) head.carrier(v) = static_cast<int>(Carrier::skull);
  for (Eigen::Index t = 0; t < head.volume.T.rows(); ++t) {
    const int region = head.volume.region(t);
    if (region == Tissue::flesh) continue;
    const Carrier bone = region == Tissue::skull ? Carrier::skull : Carrier::mandible;
    for (int k = 0; k < 4; ++k) head.carrier(head.volume.T(t, k)) = static_cast<int>(bone);
  }
}

}  // namespace

HeadSize head_size(const std::string& name) {
  for (const SizePlan& plan : plans)
    if (name == plan.name) return plan.size;
  throw Error(ErrorKind::usage, "unknown head size '" + name + "'; use preview, standard or fine");
}

std::string head_size_name(HeadSize size) {
  return plans[static_cast<std::size_t>(size)].name;
}

void build_volume(HeadTemplate& head, const TriangleMesh& skin, const VectorXi& held, const BoneSurfaces& bones,
                  HeadSize size) {
  const SizePlan& plan = plans[static_cast<std::size_t>(size)];
  // Bones may move a little for better tets, the skin may not.
  const auto give = [](const TriangleMesh& bone) -> VectorXd { return VectorXd::Constant(bone.V.rows(), 0.0005); };
  std::array<RegionSurface, 3> surfaces{
      {{"skin", {skin.V, skin.F, {}, {}}, Tissue::flesh},
       {"skull", bones.skull, Tissue::skull, false, 0, give(bones.skull)},
       {"mandible", bones.mandible, Tissue::mandible, false, 0, give(bones.mandible)}}};
  const auto s = static_cast<int>(skin.V.rows());
  head.skin_vertices = VectorXi::LinSpaced(s, 0, s - 1);
  head.skin_triangles = skin.F;
  TetrahedraliseOptions options;
  options.min_dihedral = 5;
  // Little more than is needed: where lips are thin, another mesh is another way for them to settle.
  options.improve_below = 8;
  options.insert_below = 5.2;
  options.radius_edge_ratio = plan.radius_edge_ratio;
  // Rounder tets are more tets: the bound on their shape brings the number of soft tets into the plan's range.
  double low = 1.2, high = 6;
  for (int attempt = 0; attempt < 8; ++attempt) {
    head.volume = tetrahedralise(surfaces, options);
    assign_carriers(head, held);
    const Eigen::Index count = soft_tets(head).size();
    if (count >= plan.soft_low && count <= plan.soft_high) return;
    if (count < plan.soft_low && high < 1.1 * low) {  // rounder does not do it: shorter edges in the flesh
      surfaces[0].max_edge = surfaces[0].max_edge > 0 ? 0.85 * surfaces[0].max_edge : 0.008;
      continue;
    }
    (count > plan.soft_high ? low : high) = options.radius_edge_ratio;
    options.radius_edge_ratio = std::sqrt(low * high);
  }
}

}  // namespace phiz
