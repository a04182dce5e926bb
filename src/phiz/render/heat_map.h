// SPDX-License-Identifier: GPL-3.0-or-later
/// Heat maps: a number per vertex as colour, with a legend.
#pragma once

#include <string>
#include <vector>

#include "phiz/geometry/image.h"
#include "phiz/render/scene.h"

namespace phiz {

/// Sequential: dark blue over green to yellow. Diverging: blue over white to red. Both rise (or fall to either side)
/// evenly in perceived lightness.
enum class ColourMap { sequential, diverging };

/// What the colours of a heat map mean.
struct HeatScale {
  std::string quantity;  ///< e.g. "displacement"
  std::string unit;      ///< e.g. "mm"
  double low = 0;        ///< value of the first colour
  double high = 1;       ///< value of the last colour
  ColourMap map = ColourMap::sequential;
};

/// A scale that covers the values: from 0 (when none is negative) to a round number; diverging and symmetric about 0
/// when both signs occur. Throws phiz::Error(bad_input) for values that are not finite.
HeatScale fit_heat_scale(const VectorXd& values, std::string quantity, std::string unit);

/// Display-linear RGB at t in [0, 1] of the map; t is clamped.
Vector3d map_colour(ColourMap map, double t);

/// Paints a surface with one value per vertex. The colours stay comparable with the legend's: half of the picture is
/// unlit.
void paint_heat(Surface& surface, const VectorXd& values, const HeatScale& scale);

/// Round numbers inside [low, high], about `count` of them, ascending: multiples of 1, 2 or 5 times a power of ten.
std::vector<double> legend_ticks(double low, double high, int count = 5);

/// Draws the colour bar with ticks, quantity and unit at the right edge of the image.
void draw_legend(Image& image, const HeatScale& scale);

}  // namespace phiz
