// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/bones/bones.h"

#include <memory>

#include "phiz/anatomy/bones/implicit.h"
#include "phiz/anatomy/builtin/bones/bone_shapes.h"
#include "phiz/anatomy/builtin/flesh_thickness.h"

namespace phiz {
namespace {

/// Bone shapes of the person, cut to the room that the skin leaves.
ClippedBones clipped(const Proportions& proportions, const BoneEnvelope& skin, BoneOptions options, bool detailed) {
  const auto warp = std::make_shared<ReferenceWarp>(proportions);
  options.usual_flesh = ThicknessField(proportions);
  const BoneShape skull{[warp, detailed](const Vector3d& p) { return reference_skull((*warp)(p), detailed); },
                        [warp](const Vector3d& p) { return reference_skull_struts((*warp)(p)); }};
  const BoneShape mandible{[warp](const Vector3d& p) { return reference_mandible((*warp)(p)); },
                           [warp](const Vector3d& p) { return reference_mandible_struts((*warp)(p)); }};
  return clip_bones(skull, mandible, skin, options);
}

}  // namespace

BoneSurfaces build_bones(const Proportions& proportions, const BoneEnvelope& skin, const TriangleMesh& simulated_skin,
                         const BoneOptions& options) {
  return settle_bones(clipped(proportions, skin, options, false), simulated_skin, options);
}

BoneSurfaces build_drawn_bones(const Proportions& proportions, const BoneEnvelope& skin, const BoneOptions& options) {
  const ClippedBones bones = clipped(proportions, skin, options, true);
  constexpr double seam = 0.0015;
  const ScalarField skull = [&](const Vector3d& p) {
    return implicit::blend(bones.skull(p), upper_alveolar_process(proportions, p), seam);
  };
  const ScalarField mandible = [&](const Vector3d& p) {
    return implicit::blend(bones.mandible(p), lower_alveolar_process(proportions, p), seam);
  };
  return {bone_surface(skull, skin.V, options.skull_edge, "skull"),
          bone_surface(mandible, skin.V, options.mandible_edge, "mandible")};
}

}  // namespace phiz
