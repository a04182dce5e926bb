// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/render/palette.h"

#include <cmath>

namespace phiz {

namespace {

constexpr double golden = 0.6180339887498949;

Oklab from_hue(double lightness, double chroma, double hue) {
  return {lightness, chroma * std::cos(hue), chroma * std::sin(hue)};
}

double fraction(double x) {
  return x - std::floor(x);
}

}  // namespace

Vector3d linear_rgb(const Oklab& c) {
  const auto cube = [](double v) { return v * v * v; };
  const double l = cube(c.lightness + 0.3963377774 * c.a + 0.2158037573 * c.b);
  const double m = cube(c.lightness - 0.1055613458 * c.a - 0.0638541728 * c.b);
  const double s = cube(c.lightness - 0.0894841775 * c.a - 1.2914855480 * c.b);
  return Vector3d(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
                  -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
                  -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)
      .cwiseMax(0)
      .cwiseMin(1);
}

Vector3d category_colour(int i) {
  constexpr double lightness[3] = {0.66, 0.80, 0.52};
  return linear_rgb(from_hue(lightness[i % 3], 0.145, 2 * M_PI * fraction(golden * i + 0.07)));
}

Vector3d muscle_colour(int i) {
  const double t = fraction(golden * i), hue = (21 + 15 * fraction(golden * golden * i + 0.3)) * M_PI / 180;
  return linear_rgb(from_hue(0.455 + 0.085 * t, 0.125 + 0.015 * t, hue));
}

}  // namespace phiz
