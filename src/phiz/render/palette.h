// SPDX-License-Identifier: GPL-3.0-or-later
/// Colours: a space of even lightness, hues for categories, and what tissues look like. Linear RGB.
#pragma once

#include "phiz/geometry/mesh.h"

namespace phiz {

/// OKLab (Ottosson 2020): lightness, green-red, blue-yellow.
struct Oklab {
  double lightness, a, b;
};

/// Clamped to [0, 1] per channel.
Vector3d linear_rgb(const Oklab& colour);

/// The i-th of a sequence of colours (i >= 0) that tell categories apart: neighbours in the sequence differ in hue by
/// the golden angle and in lightness.
Vector3d category_colour(int i);

/// The i-th of a sequence of reds that lie close together, neighbours in the sequence least so: muscles side by side.
Vector3d muscle_colour(int i);

/// Colours of tissue in cuts and legends.
namespace tissue_colour {
inline const Vector3d skin{0.86, 0.55, 0.43};
inline const Vector3d flesh{0.83, 0.60, 0.28};  ///< what is neither muscle nor bone: mostly fat
inline const Vector3d muscle{0.46, 0.085, 0.065};
inline const Vector3d tendon{0.72, 0.56, 0.42};
inline const Vector3d skull{0.78, 0.70, 0.55};
inline const Vector3d mandible{0.70, 0.68, 0.52};
inline const Vector3d cavity{0.50, 0.46, 0.45};  ///< rigid, where the bone as drawn is hollow
inline const Vector3d tooth{0.92, 0.90, 0.84};
inline const Vector3d gum{0.62, 0.20, 0.20};
inline const Vector3d tongue{0.56, 0.17, 0.18};
inline const Vector3d eye{0.62, 0.70, 0.76};
}  // namespace tissue_colour

}  // namespace phiz
