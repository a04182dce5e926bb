// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/render/text.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "phiz/core/error.h"
#include "phiz/render/font.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#include <stb/stb_truetype.h>
#pragma GCC diagnostic pop

namespace phiz {

namespace {

const stbtt_fontinfo& font() {
  static const stbtt_fontinfo info = [] {
    stbtt_fontinfo f;
    if (stbtt_InitFont(&f, detail::font_file(), 0) == 0) fail("the built-in typeface cannot be read", "rebuild Phiz");
    return f;
  }();
  return info;
}

/// Code points of UTF-8 text; malformed bytes become U+FFFD.
std::vector<int> code_points(std::string_view text) {
  std::vector<int> points;
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const int length = byte < 0x80 ? 1 : byte >> 5 == 6 ? 2 : byte >> 4 == 14 ? 3 : byte >> 3 == 30 ? 4 : 0;
    int point = length == 1 ? byte : byte & (0xff >> (length + 1));
    bool sound = length > 0 && i + static_cast<std::size_t>(length) <= text.size();
    for (int k = 1; sound && k < length; ++k) {
      const auto next = static_cast<unsigned char>(text[i + static_cast<std::size_t>(k)]);
      sound = next >> 6 == 2;
      point = point << 6 | (next & 0x3f);
    }
    points.push_back(sound ? point : 0xfffd);
    i += sound ? static_cast<std::size_t>(length) : 1;
  }
  return points;
}

double advance(int point, int next, double scale) {
  int width = 0, bearing = 0;
  stbtt_GetCodepointHMetrics(&font(), point, &width, &bearing);
  const int kern = next != 0 ? stbtt_GetCodepointKernAdvance(&font(), point, next) : 0;
  return (width + kern) * scale;
}

void blend(std::uint8_t* pixel, int channels, const Colour8& colour, double cover) {
  for (int k = 0; k < std::min(channels, 3); ++k)
    pixel[k] = static_cast<std::uint8_t>(std::lround(pixel[k] + (colour[k] - pixel[k]) * cover));
  if (channels == 4) pixel[3] = static_cast<std::uint8_t>(std::lround(pixel[3] + (255 - pixel[3]) * cover));
}

}  // namespace

double text_width(std::string_view text, double size) {
  const double scale = stbtt_ScaleForPixelHeight(&font(), static_cast<float>(size));
  const std::vector<int> points = code_points(text);
  double width = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    width += advance(points[i], i + 1 < points.size() ? points[i + 1] : 0, scale);
  return width;
}

std::string fitted_text(std::string_view text, double size, double width) {
  if (text_width(text, size) <= width) return std::string(text);
  for (std::size_t length = text.size(); length-- > 0;) {
    if ((static_cast<unsigned char>(text[length]) >> 6) == 2) continue;  // inside a character
    std::string cut = std::string(text.substr(0, length)) + "…";
    if (text_width(cut, size) <= width) return cut;
  }
  return {};
}

void draw_text(Image& image, double x, double y, std::string_view text, double size, const Colour8& colour,
               Align align) {
  const double scale = stbtt_ScaleForPixelHeight(&font(), static_cast<float>(size));
  if (align != Align::left) x -= text_width(text, size) * (align == Align::centre ? 0.5 : 1.0);
  const std::vector<int> points = code_points(text);
  std::vector<std::uint8_t> glyph;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double left = std::floor(x), top = std::floor(y);
    const float shift_x = static_cast<float>(x - left), shift_y = static_cast<float>(y - top);
    const float s = static_cast<float>(scale);
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    stbtt_GetCodepointBitmapBoxSubpixel(&font(), points[i], s, s, shift_x, shift_y, &x0, &y0, &x1, &y1);
    const int w = x1 - x0, h = y1 - y0;
    if (w > 0 && h > 0) {
      glyph.assign(static_cast<std::size_t>(w) * h, 0);
      stbtt_MakeCodepointBitmapSubpixel(&font(), glyph.data(), w, h, w, s, s, shift_x, shift_y, points[i]);
      for (int row = 0; row < h; ++row) {
        for (int column = 0; column < w; ++column) {
          const int px = static_cast<int>(left) + x0 + column, py = static_cast<int>(top) + y0 + row;
          if (px >= 0 && py >= 0 && px < image.width && py < image.height)
            blend(image.at(px, py), image.channels, colour, glyph[static_cast<std::size_t>(row) * w + column] / 255.0);
        }
      }
    }
    x += advance(points[i], i + 1 < points.size() ? points[i + 1] : 0, scale);
  }
}

void fill_rectangle(Image& image, int x0, int y0, int x1, int y1, const Colour8& colour, double opacity) {
  for (int y = std::max(y0, 0); y < std::min(y1, image.height); ++y)
    for (int x = std::max(x0, 0); x < std::min(x1, image.width); ++x)
      blend(image.at(x, y), image.channels, colour, opacity);
}

Image blank_image(int width, int height, const Colour8& colour) {
  Image image{width, height, 3, {}};
  image.pixels.resize(static_cast<std::size_t>(width) * height * 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = colour[i % 3];
  return image;
}

void paste(Image& target, const Image& source, int x, int y) {
  if (source.channels != target.channels)
    fail("an image cannot be pasted into one with another number of channels", "convert one of them");
  const int left = std::max(0, -x), right = std::min(source.width, target.width - x);
  if (right <= left) return;
  for (int row = std::max(0, -y); row < std::min(source.height, target.height - y); ++row)
    std::memcpy(target.at(x + left, y + row), source.at(left, row),
                static_cast<std::size_t>(right - left) * source.channels);
}

}  // namespace phiz
