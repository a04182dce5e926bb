// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/render/legend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "phiz/render/text.h"

namespace phiz {

namespace {

constexpr Colour8 ink{238, 240, 242}, paper{34, 36, 40}, frame{20, 22, 26};

double srgb_encoded(double v) {
  return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}

Colour8 encoded(const Vector3d& linear) {
  Colour8 colour;
  for (int k = 0; k < 3; ++k) colour[k] = static_cast<std::uint8_t>(std::lround(255 * srgb_encoded(linear[k])));
  return colour;
}

double letter_size(int height) {
  return std::clamp(height / 34.0, 9.0, 26.0);
}

/// Letters that leave room for all lines.
double list_letter_size(std::size_t lines, int height) {
  return std::min(0.85 * letter_size(height), height / (1.55 * static_cast<double>(lines) + 2));
}

}  // namespace

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
  const double size = letter_size(image.height);
  const int height = static_cast<int>(image.height * 0.62), width = std::max(6, static_cast<int>(size * 0.9));
  const int top = (image.height - height) / 2 + static_cast<int>(size);
  const int right = image.width - static_cast<int>(size * 3.6), left = right - width;
  fill_rectangle(image, left - 1, top - 1, right + 1, top + height + 1, frame);
  for (int y = 0; y < height; ++y) {
    const Colour8 colour = encoded(map_colour(scale.map, 1 - (y + 0.5) / height));
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

int legend_width(const std::vector<LegendEntry>& entries, int height) {
  if (entries.empty()) return 0;
  const double size = list_letter_size(entries.size(), height);
  double widest = 0;
  for (const LegendEntry& entry : entries) widest = std::max(widest, text_width(entry.name, size));
  return static_cast<int>(std::ceil(widest + 3.4 * size));
}

Image with_legend(const Image& picture, const std::vector<LegendEntry>& entries) {
  if (entries.empty()) return picture;
  const double size = list_letter_size(entries.size(), picture.height), line = 1.55 * size;
  Image image = blank_image(picture.width + legend_width(entries, picture.height), picture.height, paper);
  paste(image, picture, 0, 0);
  const double left = picture.width + size;
  double y = (picture.height - line * static_cast<double>(entries.size())) / 2;
  for (const LegendEntry& entry : entries) {
    const int x = static_cast<int>(left), top = static_cast<int>(y + 0.2 * size), side = static_cast<int>(size);
    fill_rectangle(image, x - 1, top - 1, x + side + 1, top + side + 1, frame);
    fill_rectangle(image, x, top, x + side, top + side, encoded(entry.colour));
    draw_text(image, left + 1.5 * size, y + size, entry.name, size, ink);
    y += line;
  }
  return image;
}

}  // namespace phiz
