// SPDX-License-Identifier: GPL-3.0-or-later
/// PNG pictures.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "phiz/geometry/image.h"

namespace phiz {

/// 16 bits per channel: depth images, displacement maps. Layout as in Image; the meaning of the values is the caller's.
struct DeepImage {
  int width = 0;
  int height = 0;
  int channels = 1;                   ///< 1 grey, 3 RGB or 4 RGBA
  std::vector<std::uint16_t> pixels;  ///< width * height * channels
};

/// Reads any PNG (1 to 16 bits, grey, palette, RGB, with or without alpha) as 8 bits; 16-bit files are rounded, grey
/// with alpha becomes RGBA. Throws phiz::Error(bad_input) for a file that is not PNG, is cut off, fails its checksums
/// or claims a size that its bytes cannot hold.
Image read_png(const std::string& path);
Image parse_png(std::string_view bytes, const std::string& where);

/// The same with 16 bits per channel; values of 8-bit files are multiplied by 257.
DeepImage read_deep_png(const std::string& path);
DeepImage parse_deep_png(std::string_view bytes, const std::string& where);

/// Writes 8 or 16 bits per channel. Throws phiz::Error(failure) when the image's sizes disagree.
void write_png(const std::string& path, const Image& image);
void write_png(const std::string& path, const DeepImage& image);

/// The bytes of the PNG file, e.g. for a web server.
std::string png_bytes(const Image& image);
std::string png_bytes(const DeepImage& image);

}  // namespace phiz
