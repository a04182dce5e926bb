// SPDX-License-Identifier: GPL-3.0-or-later
/// Many pictures on one sheet, each with a caption.
#pragma once

#include <string>
#include <vector>

#include "phiz/geometry/image.h"

namespace phiz {

struct SheetCell {
  Image image;
  std::string caption;  ///< one line, cut to the width of its picture
};

struct SheetOptions {
  std::string title;      ///< above the pictures; none when empty
  int columns = 0;        ///< 0: as many as make the sheet about 3 : 2
  int gap = 10;           ///< pixels between pictures
  double text_size = 17;  ///< pixels
};

/// RGB sheet of the pictures in reading order. All pictures get a cell of the largest one's size. Throws
/// phiz::Error(bad_input) when there are none or one is not RGB.
Image contact_sheet(const std::vector<SheetCell>& cells, const SheetOptions& options = {});

}  // namespace phiz
