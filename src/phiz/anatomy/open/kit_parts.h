// SPDX-License-Identifier: GPL-3.0-or-later
/// Teeth, gums, tongue and eyes of the face kit as parts of a head.
#pragma once

#include <vector>

#include "phiz/anatomy/head_template.h"
#include "phiz/anatomy/open/sources.h"

namespace phiz {

/// upperTeeth, lowerTeeth, upperGums, lowerGums, tongue (with its shape tongueOut), leftEye, rightEye; and the rows of
/// the kit's vertices that each part's vertices are. The gums are open sheets: what moves with the jaw in jawOpen goes
/// to the lower ones, and there the tongue is what lies nearer to its back than to the teeth, along the surface.
struct KitParts {
  std::vector<Part> parts;
  std::vector<VectorXi> rows;  ///< per part
};
KitParts kit_parts(const FaceKit& kit);

}  // namespace phiz
