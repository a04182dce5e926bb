// SPDX-License-Identifier: GPL-3.0-or-later
/// The layer between the outer skin and what lies beneath it: bones, mouth, eye sockets.
#pragma once

#include "phiz/anatomy/open/face_kit_skin.h"
#include "phiz/anatomy/open/registration.h"
#include "phiz/geometry/spatial_query.h"

namespace phiz {

class FleshLayer {
 public:
  FleshLayer(const FaceKitSkin& skin, const BoneSolids& bones);

  /// How to move p so that it lies in the flesh: at least 1.5 mm under the skin and 0.6 mm above what lies beneath,
  /// less where the flesh is thin. Zero when it does.
  Vector3d into_flesh(const Vector3d& p) const;

 private:
  MatrixX3i outer_;
  MatrixX3d normals_;
  SurfaceQuery skin_, floor_;
};

}  // namespace phiz
