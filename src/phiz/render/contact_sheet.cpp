// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/render/contact_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "phiz/core/error.h"
#include "phiz/render/text.h"

namespace phiz {

Image contact_sheet(const std::vector<SheetCell>& cells, const SheetOptions& options) {
  if (cells.empty()) reject("contact sheet", "there are no pictures");
  int width = 0, height = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i].image.channels != 3)
      reject("contact sheet", fmt::format("picture {} has {} channels instead of 3", i, cells[i].image.channels));
    width = std::max(width, cells[i].image.width);
    height = std::max(height, cells[i].image.height);
  }
  const int gap = std::max(options.gap, 0);
  const bool captions = std::any_of(cells.begin(), cells.end(), [](const SheetCell& c) { return !c.caption.empty(); });
  const int caption = captions ? static_cast<int>(std::lround(options.text_size * 1.5)) : 0;
  const int title = options.title.empty() ? 0 : static_cast<int>(std::lround(options.text_size * 2.4));
  const int count = static_cast<int>(cells.size());
  int columns = options.columns;
  if (columns <= 0)
    columns = static_cast<int>(std::lround(std::sqrt(1.5 * count * (height + caption + gap) / (width + gap))));
  columns = std::clamp(columns, 1, count);
  const int rows = (count + columns - 1) / columns;

  Image sheet = blank_image(columns * (width + gap) + gap, title + rows * (height + caption + gap) + gap, {34, 36, 40});
  if (title > 0)
    draw_text(sheet, gap, gap + options.text_size * 1.25,
              fitted_text(options.title, options.text_size * 1.35, sheet.width - 2 * gap), options.text_size * 1.35,
              {236, 238, 240});
  for (int i = 0; i < count; ++i) {
    const SheetCell& cell = cells[i];
    const int x = gap + i % columns * (width + gap), y = gap + title + i / columns * (height + caption + gap);
    paste(sheet, cell.image, x + (width - cell.image.width) / 2, y + (height - cell.image.height) / 2);
    if (!cell.caption.empty())
      draw_text(sheet, x + width / 2.0, y + height + options.text_size * 1.05,
                fitted_text(cell.caption, options.text_size, width), options.text_size, {205, 208, 212}, Align::centre);
  }
  return sheet;
}

}  // namespace phiz
