// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <limits>

#include "phiz/render/legend.h"
#include "phiz/render/palette.h"
#include "phiz/render/text.h"

namespace phiz {
namespace {

TEST(Legend, TicksAreRoundAndInside) {
  EXPECT_EQ(legend_ticks(0, 10), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(legend_ticks(-1, 1, 4), (std::vector<double>{-1, -0.5, 0, 0.5, 1}));
  for (const auto& [low, high] :
       {std::pair{0.0, 0.37}, std::pair{-3.3, 8.1}, std::pair{1e-7, 9e-7}, std::pair{100.0, 101.0}}) {
    const std::vector<double> ticks = legend_ticks(low, high);
    EXPECT_GE(ticks.size(), 3U);
    EXPECT_LE(ticks.size(), 11U);
    for (const double t : ticks) EXPECT_TRUE(t >= low - 1e-9 * (high - low) && t <= high + 1e-9 * (high - low));
  }
  EXPECT_TRUE(legend_ticks(1, 1).empty());
  EXPECT_TRUE(legend_ticks(0, std::numeric_limits<double>::infinity()).empty());
}

TEST(Legend, BarShowsTheEndsOfTheMap) {
  Image image = blank_image(400, 400, {0, 0, 0});
  draw_legend(image, {"displacement", "mm", 0, 4, ColourMap::sequential});
  int yellow = 0, blue = 0;
  for (int y = 0; y < 400; ++y) {
    for (int x = 200; x < 400; ++x) {
      const std::uint8_t* p = image.at(x, y);
      if (p[0] > 200 && p[1] > 200 && p[2] < 100) ++yellow;
      if (p[2] > p[0] + 40 && p[1] < 80) ++blue;
    }
  }
  EXPECT_GT(yellow, 20);
  EXPECT_GT(blue, 20);
}

TEST(Legend, NamesStandBesideThePictureWithTheirColours) {
  const Image picture = blank_image(300, 200, {10, 20, 30});
  const std::vector<LegendEntry> entries = {{"red", {1, 0, 0}}, {"green", {0, 1, 0}}};
  const Image both = with_legend(picture, entries);
  ASSERT_EQ(both.width, 300 + legend_width(entries, 200));
  ASSERT_EQ(both.height, 200);
  EXPECT_EQ(both.at(299, 199)[2], 30);
  int red_row = -1, green_row = -1;
  for (int y = 0; y < 200; ++y) {
    for (int x = 300; x < both.width; ++x) {
      const std::uint8_t* p = both.at(x, y);
      if (p[0] == 255 && p[1] == 0 && p[2] == 0) red_row = y;
      if (p[0] == 0 && p[1] == 255 && p[2] == 0 && green_row < 0) green_row = y;
    }
  }
  EXPECT_GE(red_row, 0);
  EXPECT_GT(green_row, red_row);
}

TEST(Legend, ManyNamesBecomeSmallEnoughToFit) {
  std::vector<LegendEntry> entries(60, {"a", {0.2, 0.5, 0.2}});
  entries.back() = {"last", {1, 0, 1}};
  const Image image = with_legend(blank_image(100, 300, {0, 0, 0}), entries);
  bool seen = false;
  for (int y = 0; y < 300; ++y)
    for (int x = 100; x < image.width; ++x) seen |= image.at(x, y)[0] == 255 && image.at(x, y)[1] == 0;
  EXPECT_TRUE(seen);
}

TEST(Legend, NothingIsAddedForNoNames) {
  EXPECT_EQ(legend_width({}, 200), 0);
  EXPECT_EQ(with_legend(blank_image(30, 20, {0, 0, 0}), {}).width, 30);
}

TEST(Palette, CategoriesAreFarApartAndMusclesAreRed) {
  for (int i = 0; i < 24; ++i) {
    for (int j = 0; j < i; ++j) EXPECT_GT((category_colour(i) - category_colour(j)).norm(), 0.03) << i << ", " << j;
    const Vector3d red = muscle_colour(i);
    EXPECT_GT(red.x(), 2.5 * red.y()) << i;
    EXPECT_GT(red.x(), 2.5 * red.z()) << i;
    if (i > 0) {
      EXPECT_GT((red - muscle_colour(i - 1)).norm(), 0.015) << i;
    }
  }
}

}  // namespace
}  // namespace phiz
