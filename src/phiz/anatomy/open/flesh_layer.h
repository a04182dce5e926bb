// SPDX-License-Identifier: GPL-3.0-or-later
/// The layer between the outer skin and what lies beneath it: bones, mouth, eye sockets.
#pragma once

#include <span>

#include "phiz/anatomy/open/face_kit_skin.h"
#include "phiz/geometry/spatial_query.h"

namespace phiz {

class FleshLayer {
 public:
  /// `bones`: surfaces that muscles must stay out of.
  FleshLayer(const FaceKitSkin& skin, std::span<const TriangleMesh> bones);

  /// How to move p so that it lies in the flesh: at least 1.5 mm under the skin and 0.6 mm above what lies beneath,
  /// less where the flesh is thin. Zero when it does.
  Vector3d into_flesh(const Vector3d& p) const;
  /// How to move points that lie together, as a whole, so that all of them do; evenly between skin and floor where there
  /// is not room enough.
  Vector3d all_into_flesh(const MatrixX3d& points) const;

 private:
  /// Where flesh may be under the nearest place of the skin: between the depths `least` and `most`.
  struct Room {
    Vector3d skin, out;
    double least, most;
  };
  Room room_at(const Vector3d& p) const;

  MatrixX3i outer_;
  MatrixX3d normals_;
  SurfaceQuery skin_, floor_;
};

}  // namespace phiz
