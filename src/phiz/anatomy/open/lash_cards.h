// SPDX-License-Identifier: GPL-3.0-or-later
/// The face kit's cards of eyelashes: where they spring from tells where the margins of the lids are.
#pragma once

#include <vector>

#include "phiz/anatomy/open/sources.h"

namespace phiz {

/// A card is a grid of quads.
struct LashCard {
  bool upper = true;
  std::vector<std::vector<int>> lines;  ///< kit vertices, from the roots to the tips, each from the inner corner out
};

/// The six cards of an eye. Throws phiz::Error(bad_input) when they are not the face kit's.
std::vector<LashCard> lash_cards(const FaceKit& kit, bool left);

/// The vertices of the skin that the lashes of a lid spring from.
std::vector<int> lash_roots(const FaceKit& kit, bool left, bool upper);

}  // namespace phiz
