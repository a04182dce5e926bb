// SPDX-License-Identifier: GPL-3.0-or-later
/// Brings the anatomy of one man into another face: a similarity, then a smooth warp of space that puts bones at the
/// usual depth under the skin (Ichim et al. 2017, section 5.3) and teeth and eyes onto teeth and eyes.
#pragma once

#include <vector>

#include "phiz/anatomy/open/face_guide.h"
#include "phiz/anatomy/open/sources.h"
#include "phiz/numerics/rbf.h"

namespace phiz {

/// Skull and mandible as solid shapes without chambers, in the frame of the parts.
struct BoneSolids {
  TriangleMesh skull, mandible;
};
BoneSolids solid_bones(const BodyParts& parts);

/// A map of space: a similarity, then smooth displacements one after the other.
struct SpaceMap {
  double scale = 1;
  Matrix3d rotation = Matrix3d::Identity();
  Vector3d translation = Vector3d::Zero();
  std::vector<Rbf> displacements;

  MatrixX3d operator()(const MatrixX3d& points) const;
};

struct RegistrationOptions {
  /// Smoothing of the displacements, one round each (see Rbf); from stiff to soft.
  std::vector<double> smoothing{0.5, 0.3, 0.2, 0.1, 0.05, 0.03, 0.02, 0.02};
  double sample_spacing = 0.009;  ///< between the points of bone that are put to their depth, metres
};

/// The map from the frame of the parts into the frame of the face. Deterministic.
SpaceMap register_anatomy(const BodyParts& parts, const BoneSolids& solids, const FaceGuide& guide,
                          const RegistrationOptions& options = {});

}  // namespace phiz
