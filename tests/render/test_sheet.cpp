// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>

#include "phiz/core/error.h"
#include "phiz/render/contact_sheet.h"
#include "phiz/render/text.h"

namespace phiz {
namespace {

TEST(Text, WidthAddsUpAndTextIsCutToFit) {
  EXPECT_EQ(text_width("", 20), 0);
  EXPECT_NEAR(text_width("mm mm", 40), 2 * text_width("mm mm", 20), 1e-4);
  EXPECT_GT(text_width("MMMM", 20), text_width("iiii", 20));
  EXPECT_EQ(fitted_text("short", 16, 500), "short");
  const std::string cut = fitted_text("une étude très longue", 16, 80);
  EXPECT_LE(text_width(cut, 16), 80);
  EXPECT_EQ(cut.substr(cut.size() - 3), "…");
}

TEST(Text, StaysInsideTheImageAndSurvivesBrokenUtf8) {
  Image image = blank_image(40, 20, {0, 0, 0});
  draw_text(image, -30, 10, "outside on both sides, and longer", 18, {255, 255, 255});
  draw_text(image, 5, 500, "below", 18, {255, 255, 255});
  draw_text(image, 5, 15, "\xff\xc3", 12, {255, 255, 255});
  EXPECT_EQ(image.pixels.size(), 40U * 20U * 3U);
  EXPECT_GT(*std::max_element(image.pixels.begin(), image.pixels.end()), 100);
}

TEST(ContactSheet, KeepsEveryPictureInReadingOrder) {
  std::vector<SheetCell> cells;
  for (int i = 0; i < 5; ++i)
    cells.push_back({blank_image(30, 20, {static_cast<std::uint8_t>(40 * i + 50), 0, 0}), "picture"});
  const Image sheet = contact_sheet(cells, {.title = "Title", .columns = 2});
  int row = 0, column = 0, found = 0;
  for (int y = 0; y < sheet.height; ++y) {
    for (int x = 0; x < sheet.width; ++x) {
      const std::uint8_t* p = sheet.at(x, y);
      if (p[1] == 0 && p[2] == 0 && p[0] == 40 * found + 50) {
        EXPECT_TRUE(y > row || (y == row && x > column));
        row = y;
        column = x;
        if (++found == 5) return;
      }
    }
  }
  FAIL() << found << " of 5 pictures found";
}

TEST(ContactSheet, RefusesNothingAndGrey) {
  EXPECT_THROW(contact_sheet({}), Error);
  EXPECT_THROW(contact_sheet({{Image{2, 2, 1, {0, 0, 0, 0}}, ""}}), Error);
}

}  // namespace
}  // namespace phiz
