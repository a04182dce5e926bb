// SPDX-License-Identifier: GPL-3.0-or-later
/// Legends: what the colours of a picture mean.
#pragma once

#include <string>
#include <vector>

#include "phiz/geometry/image.h"
#include "phiz/render/heat_map.h"

namespace phiz {

/// A colour (linear RGB) and what it stands for.
struct LegendEntry {
  std::string name;
  Vector3d colour;
};

/// Draws the colour bar with ticks, quantity and unit at the right edge of the image.
void draw_legend(Image& image, const HeatScale& scale);

/// Width in pixels of a list of names beside a picture of this height: as wide as its longest name needs.
int legend_width(const std::vector<LegendEntry>& entries, int height);

/// The picture (RGB) with the list of names on a strip of legend_width beside it, on the right.
Image with_legend(const Image& picture, const std::vector<LegendEntry>& entries);

/// Round numbers inside [low, high], about `count` of them, ascending: multiples of 1, 2 or 5 times a power of ten.
std::vector<double> legend_ticks(double low, double high, int count = 5);

}  // namespace phiz
