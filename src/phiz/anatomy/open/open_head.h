// SPDX-License-Identifier: GPL-3.0-or-later
/// The open-anatomy head: the skin, mouth, eyes, expressions and people of ICT Face Model Light over the bones and
/// muscles of BodyParts3D.
#pragma once

#include <functional>
#include <string>

#include "phiz/anatomy/head_template.h"
#include "phiz/anatomy/head_volume.h"
#include "phiz/anatomy/open/sources.h"

namespace phiz {

inline constexpr int open_head_steps = 10;  ///< how often `report` is called

struct OpenHeadOptions {
  HeadSize size = HeadSize::standard;
  std::function<void(const std::string&)> report;  ///< told what is being done, when set
};

/// Builds the head. Vertices of the drawn skin 0 to 14061 are the face kit's, in its order, with its texture
/// coordinates; the simulation skin is a coarser mesh on it. Deterministic. Throws phiz::Error when the data do not fit
/// together.
HeadTemplate build_open_head(const FaceKit& kit, const BodyParts& parts, const OpenHeadOptions& options = {});

}  // namespace phiz
