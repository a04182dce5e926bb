// SPDX-License-Identifier: GPL-3.0-or-later
/// Text and rectangles drawn on images: captions, legends. The typeface (DejaVu Sans) is built into the library.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "phiz/geometry/image.h"

namespace phiz {

using Colour8 = std::array<std::uint8_t, 3>;  ///< sRGB

enum class Align { left, centre, right };

/// Draws one line of UTF-8 text. (x, y): the left end, middle or right end of the baseline in pixels; `size`: height of
/// capitals and descenders together, pixels. What lies outside of the image is left out.
void draw_text(Image& image, double x, double y, std::string_view text, double size, const Colour8& colour,
               Align align = Align::left);

/// Width of the text in pixels.
double text_width(std::string_view text, double size);

/// The longest beginning of the text that fits into `width` pixels, with an ellipsis if it had to be cut.
std::string fitted_text(std::string_view text, double size, double width);

/// Fills the rectangle [x0, x1) x [y0, y1), clipped to the image. `opacity` in [0, 1].
void fill_rectangle(Image& image, int x0, int y0, int x1, int y1, const Colour8& colour, double opacity = 1);

/// A new image of one colour.
Image blank_image(int width, int height, const Colour8& colour);

/// Copies `source` (as many channels) into `target` with its top left corner at (x, y), clipped.
void paste(Image& target, const Image& source, int x, int y);

}  // namespace phiz
