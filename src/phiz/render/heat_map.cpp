// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/render/heat_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "phiz/core/error.h"
#include "phiz/render/text.h"

namespace phiz {

namespace {

/// OKLab (Ottosson 2020): lightness, green-red, blue-yellow.
struct Oklab {
  double lightness, a, b;
};

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

// Evenly spaced colours; the lightness is linear in the position.
constexpr std::array<Oklab, 6> sequential_stops = {{{0.25, 0.035, -0.120},
                                                    {0.38, -0.010, -0.105},
                                                    {0.51, -0.060, -0.045},
                                                    {0.64, -0.095, 0.035},
                                                    {0.77, -0.085, 0.115},
                                                    {0.90, -0.020, 0.165}}};
constexpr std::array<Oklab, 5> diverging_stops = {
    {{0.40, -0.010, -0.150}, {0.67, -0.030, -0.085}, {0.94, 0.000, 0.000}, {0.67, 0.105, 0.070}, {0.40, 0.145, 0.075}}};

double srgb_encoded(double v) {
  return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}

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

std::vector<double> legend_ticks(double low, double high, int count) {
  std::vector<double> ticks;
  if (!(high > low) || !std::isfinite(high - low) || count < 1) return ticks;
  const double raw = (high - low) / count;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  const double step = raw <= 1.5 * power   ? power
                      : raw <= 3.5 * power ? 2 * power
                      : raw <= 7.5 * power ? 5 * power
                                           : 10 * power;
  const double slack = 1e-9 * (high - low);
  for (double k = std::ceil((low - slack) / step); k * step <= high + slack; ++k) ticks.push_back(k * step + 0.0);
  return ticks;
}

void draw_legend(Image& image, const HeatScale& scale) {
  const double size = std::clamp(image.height / 34.0, 9.0, 26.0);
  const int height = static_cast<int>(image.height * 0.62), width = std::max(6, static_cast<int>(size * 0.9));
  const int top = (image.height - height) / 2 + static_cast<int>(size);
  const int right = image.width - static_cast<int>(size * 3.6), left = right - width;
  const Colour8 ink{238, 240, 242};
  fill_rectangle(image, left - 1, top - 1, right + 1, top + height + 1, {20, 22, 26});
  for (int y = 0; y < height; ++y) {
    const Vector3d c = map_colour(scale.map, 1 - (y + 0.5) / height);
    Colour8 colour;
    for (int k = 0; k < 3; ++k) colour[k] = static_cast<std::uint8_t>(std::lround(255 * srgb_encoded(c[k])));
    fill_rectangle(image, left, top + y, right, top + y + 1, colour);
  }
  for (const double tick : legend_ticks(scale.low, scale.high)) {
    const double y = top + height * (scale.high - tick) / (scale.high - scale.low);
    const int row = std::clamp(static_cast<int>(y), top, top + height - 1);
    fill_rectangle(image, right + 1, row, right + 1 + static_cast<int>(size * 0.3), row + 1, ink);
    draw_text(image, right + size * 0.55, y + size * 0.32, fmt::format("{:.6g}", tick), size, ink);
  }
  const double edge = image.width - size * 0.6;
  draw_text(image, edge, top - size * 1.7, scale.quantity, size, ink, Align::right);
  draw_text(image, edge, top - size * 0.65, scale.unit, size, ink, Align::right);
}

}  // namespace phiz
