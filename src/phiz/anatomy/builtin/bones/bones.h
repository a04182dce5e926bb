// SPDX-License-Identifier: GPL-3.0-or-later
/// Skull and mandible of one person as closed surfaces inside the skin.
#pragma once

#include "phiz/anatomy/builtin/proportions.h"
#include "phiz/geometry/mesh.h"

namespace phiz {

struct BoneSurfaces {
  TriangleMesh skull;     ///< cranium and cervical column, solid
  TriangleMesh mandible;  ///< solid
};

/// The skin that the bones lie in: the outer skin, and the inner sheets (oral cavity, eye sockets, nostrils) which may
/// come nearer to the bone. Together they are closed and outward.
struct BoneEnvelope {
  MatrixX3d V;
  MatrixX3i outer;  ///< triangles over rows of V
  MatrixX3i inner;
};

struct BoneOptions {
  double skull_edge = 0.0105;  ///< wanted edge of the triangles, metres
  double mandible_edge = 0.0075;
  double inner_clearance = 0.0015;  ///< between bone and the inner sheets
  double least_flesh = 0.0025;      ///< between bone and the outer skin, wherever the usual thickness is less
  double joint_gap = 0.0016;        ///< between skull and mandible
};

/// Closed, outward, non-self-intersecting bones that keep the flesh thickness of flesh_thickness.h below the outer
/// skin, `inner_clearance` from the inner sheets and `joint_gap` from each other (to within a third of these at coarse
/// edge lengths). `skin`: fine enough to be close to the smooth surface; `simulated_skin`:
/// what the bones must not touch. Throws phiz::Error(failure) when the skin leaves no room for them.
BoneSurfaces build_bones(const Proportions& proportions, const BoneEnvelope& skin, const TriangleMesh& simulated_skin,
                         const BoneOptions& options);

/// Bones to look at: the same with their alveolar processes, which stand in the oral cavity inside the gums.
BoneSurfaces build_drawn_bones(const Proportions& proportions, const BoneEnvelope& skin, const BoneOptions& options);

}  // namespace phiz
