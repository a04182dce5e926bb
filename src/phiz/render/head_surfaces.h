// SPDX-License-Identifier: GPL-3.0-or-later
/// Internal: what head_view.cpp and take_view.cpp build their scenes from. Included by sources only.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
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

bool is_bone(const Part& part);
bool is_eye(const Part& part);
/// Whether the part's name holds one of the words, whatever the case.
bool has_name(const Part& part, std::initializer_list<std::string_view> words);

/// The skin as the style shows it.
Surface skin_surface(const PosedHead& posed, const HeadViewOptions& options);
/// Part number i, in its own colours or in clay.
Surface part_surface(const PosedHead& posed, std::size_t i, bool coloured);

/// What the styles of the same names show.
void add_cutaway(Scene& scene, const PosedHead& posed, const HeadViewOptions& options);
void add_attachments(Scene& scene, const PosedHead& posed);
void add_contacts(Scene& scene, const PosedHead& posed, const HeadViewOptions& options);

/// The scene in the head frame.
Scene build_scene(const PosedHead& posed, const HeadViewOptions& options);

}  // namespace phiz::detail
