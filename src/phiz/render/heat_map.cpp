// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/render/heat_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "phiz/core/error.h"
#include "phiz/render/palette.h"

namespace phiz {

namespace {

// Evenly spaced colours; the lightness is linear in the position.
constexpr std::array<Oklab, 6> sequential_stops = {{{0.25, 0.035, -0.120},
                                                    {0.38, -0.010, -0.105},
                                                    {0.51, -0.060, -0.045},
                                                    {0.64, -0.095, 0.035},
                                                    {0.77, -0.085, 0.115},
                                                    {0.90, -0.020, 0.165}}};
constexpr std::array<Oklab, 5> diverging_stops = {
    {{0.40, -0.010, -0.150}, {0.67, -0.030, -0.085}, {0.94, 0.000, 0.000}, {0.67, 0.105, 0.070}, {0.40, 0.145, 0.075}}};

/// 1, 2, 2.5, 5 or 10 times a power of ten, not below v.
double round_up(double v) {
  const double power = std::pow(10.0, std::floor(std::log10(v)));
  for (const double step : {1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0})
    if (v <= step * power * (1 + 1e-9)) return step * power;
  return 10 * power;
}

}  // namespace

Vector3d map_colour(ColourMap map, double t) {
  const std::span<const Oklab> stops =
      map == ColourMap::sequential ? std::span<const Oklab>(sequential_stops) : std::span<const Oklab>(diverging_stops);
  const double position = std::clamp(t, 0.0, 1.0) * static_cast<double>(stops.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(position), stops.size() - 2);
  const double f = position - static_cast<double>(i);
  const Oklab &p = stops[i], &q = stops[i + 1];
  return linear_rgb({p.lightness + f * (q.lightness - p.lightness), p.a + f * (q.a - p.a), p.b + f * (q.b - p.b)});
}

HeatScale fit_heat_scale(const VectorXd& values, std::string quantity, std::string unit) {
  if (!values.allFinite()) reject("heat map of " + quantity, "a value is not finite");
  HeatScale scale;
  scale.quantity = std::move(quantity);
  scale.unit = std::move(unit);
  if (values.size() == 0) return scale;
  const double least = values.minCoeff(), most = values.maxCoeff();
  const double reach = std::max(std::abs(least), std::abs(most));
  if (reach < 1e-300) return scale;
  const double end = round_up(reach);
  if (least < 0 && most > 0 && -least > 0.02 * reach && most > 0.02 * reach) {
    scale.map = ColourMap::diverging;
    scale.low = -end;
    scale.high = end;
  } else if (most > -least) {
    scale.low = 0;
    scale.high = end;
  } else {
    scale.low = -end;
    scale.high = 0;
  }
  return scale;
}

void paint_heat(Surface& surface, const VectorXd& values, const HeatScale& scale) {
  const std::string where = "heat map of " + scale.quantity;
  if (values.size() != surface.mesh.V.rows())
    reject(where, fmt::format("{} values for {} vertices", values.size(), surface.mesh.V.rows()));
  if (!values.allFinite()) reject(where, "a value is not finite");
  if (!(scale.high > scale.low)) reject(where, "the scale's upper end is not above its lower end");
  surface.colour.resize(values.size(), 3);
  for (Eigen::Index i = 0; i < values.size(); ++i)
    surface.colour.row(i) = map_colour(scale.map, (values[i] - scale.low) / (scale.high - scale.low)).transpose();
  Material& m = surface.material;
  m = Material();
  m.albedo = Vector3d::Ones();
  m.roughness = 0.6;
  m.specular = 0.02;
  m.unlit = 0.6;
}

}  // namespace phiz
