// SPDX-License-Identifier: GPL-3.0-or-later
/// Puts bones into a skin: implicit shapes of skull and mandible, cut to the room that the skin leaves, become closed
/// surfaces that tets can be made between.
#pragma once

#include <functional>

#include "phiz/geometry/mesh.h"

namespace phiz {

/// Negative inside, positive outside, close to the distance near its zero set, metres. Called from several threads.
using ScalarField = std::function<double(const Vector3d&)>;

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

/// The shape of a bone, and the part of it that must not break where the flesh over it is thin (may be missing).
struct BoneShape {
  ScalarField shape, struts;
};

struct BoneOptions {
  double skull_edge = 0.0105;  ///< wanted edge of the triangles, metres
  double mandible_edge = 0.0075;
  double inner_clearance = 0.0015;  ///< between bone and the inner sheets
  double least_flesh = 0.0025;      ///< between bone and the outer skin, everywhere
  double joint_gap = 0.0016;        ///< between skull and mandible
  ScalarField usual_flesh;  ///< thickness of the flesh over bones but their struts; the least flesh when missing
};

/// The shapes, cut to the room under the skin and clear of each other.
struct ClippedBones {
  ScalarField skull, mandible;
};
ClippedBones clip_bones(const BoneShape& skull, const BoneShape& mandible, const BoneEnvelope& skin,
                        const BoneOptions& options);

/// The largest piece of a bone as a surface with edges of about `edge_length`; `around`: points whose box holds it.
/// Throws phiz::Error(failure), which names it, when there is none.
TriangleMesh bone_surface(const ScalarField& bone, const MatrixX3d& around, double edge_length, const char* name);

/// Moves the vertices of `bone` that lie nearer to the skin than `least` (metres) away from it, and those of triangles
/// that skin vertices come nearer to, in small steps.
void keep_clear(TriangleMesh& bone, const TriangleMesh& skin, double least);

/// Closed, outward, non-self-intersecting bones that keep `inner_clearance` from the inner sheets, `least_flesh` from
/// the outer skin and `joint_gap` from each other (to within a third of these at coarse edge lengths).
/// `simulated_skin`: what the bones must not touch. Throws phiz::Error(failure) when the skin leaves no room for them.
BoneSurfaces settle_bones(const ClippedBones& bones, const TriangleMesh& simulated_skin, const BoneOptions& options);

}  // namespace phiz
