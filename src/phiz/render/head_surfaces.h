// SPDX-License-Identifier: GPL-3.0-or-later
/// Internal: what head_view.cpp and take_view.cpp build their scenes from. Included by sources only.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "phiz/render/head_view.h"

namespace phiz::detail {

/// A head in some pose, in the head frame.
struct PosedHead {
  const TriangleMesh* skin = nullptr;  ///< at rest
  MatrixX3d skin_now;                  ///< its vertices now
  const std::vector<Part>* parts = nullptr;
  std::vector<Eigen::Isometry3d> motion;  ///< per part
  std::vector<MatrixX3d> part_now;        ///< deformed vertices before the motion, per part; empty: at rest
  const HeadTemplate* head = nullptr;     ///< for regions, muscles and tissue; may be missing
  MatrixX3d volume_now;                   ///< vertices of head->volume now; empty: no tissue is shown
  Vector3d left_eye = Vector3d::Zero(), right_eye = Vector3d::Zero();
};

/// The scene in the head frame.
Scene build_scene(const PosedHead& posed, const HeadViewOptions& options);

}  // namespace phiz::detail
