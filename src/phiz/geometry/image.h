// SPDX-License-Identifier: GPL-3.0-or-later
/// The image value that the renderer makes and the PNG reader and writer (io/png.h) exchange.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace phiz {

/// 8-bit image, rows from top to bottom, pixels from left to right, channels interleaved. Colour is sRGB-encoded,
/// alpha (channel 4, when there is one) is linear and not premultiplied.
struct Image {
  int width = 0;
  int height = 0;
  int channels = 3;                  ///< 1 grey, 3 RGB or 4 RGBA
  std::vector<std::uint8_t> pixels;  ///< width * height * channels

  /// First channel of the pixel in column x and row y (row 0 is the top).
  std::uint8_t* at(int x, int y) { return pixels.data() + (static_cast<std::size_t>(y) * width + x) * channels; }
  const std::uint8_t* at(int x, int y) const {
    return pixels.data() + (static_cast<std::size_t>(y) * width + x) * channels;
  }
};

}  // namespace phiz
