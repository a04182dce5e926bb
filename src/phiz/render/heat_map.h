// SPDX-License-Identifier: GPL-3.0-or-later
/// Heat maps: a number per vertex as colour. Their legend: legend.h.
#pragma once

#include <string>

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

}  // namespace phiz
