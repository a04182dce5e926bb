// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <numeric>

#include "io/expect_error.h"
#include "io/temporary_folder.h"
#include "phiz/io/file_bytes.h"
#include "phiz/io/output_file.h"
#include "phiz/io/png.h"
#include "phiz/io/point_cache.h"

namespace phiz {
namespace {

TEST(Png, eight_and_sixteen_bits_read_back_the_same) {
  const TemporaryFolder folder;
  for (const int channels : {1, 3, 4}) {
    Image image{5, 3, channels, std::vector<std::uint8_t>(static_cast<std::size_t>(15 * channels))};
    std::iota(image.pixels.begin(), image.pixels.end(), std::uint8_t{100});
    write_png(folder.file("a.png"), image);
    const Image back = read_png(folder.file("a.png"));
    EXPECT_EQ(back.width, 5);
    EXPECT_EQ(back.height, 3);
    EXPECT_EQ(back.channels, channels);
    EXPECT_EQ(back.pixels, image.pixels);

    DeepImage deep{5, 3, channels, std::vector<std::uint16_t>(static_cast<std::size_t>(15 * channels))};
    std::iota(deep.pixels.begin(), deep.pixels.end(), std::uint16_t{1000});
    write_png(folder.file("b.png"), deep);
    EXPECT_EQ(read_deep_png(folder.file("b.png")).pixels, deep.pixels);
    EXPECT_EQ(read_png(folder.file("b.png")).channels, channels);
    EXPECT_EQ(read_deep_png(folder.file("a.png")).pixels[1], image.pixels[1] * 257);
  }
}

TEST(Png, refuses_damaged_files_and_impossible_images) {
  const Image image{64, 64, 3, std::vector<std::uint8_t>(64 * 64 * 3, 7)};
  std::string bytes = png_bytes(image);
  EXPECT_REJECTED(parse_png(bytes.substr(0, bytes.size() / 2), "a.png"), "a.png");
  EXPECT_REJECTED(parse_png("hello", "a.png"), "not a PNG");
  std::string flipped = bytes;
  flipped[bytes.size() / 2] = static_cast<char>(flipped[bytes.size() / 2] ^ 1);
  EXPECT_REJECTED(parse_png(flipped, "a.png"), "a.png");
  message_of([&] { png_bytes(Image{2, 2, 3, {1, 2}}); }, ErrorKind::failure);
  message_of([&] { png_bytes(Image{-2, 2, 2, {}}); }, ErrorKind::failure);
}

PointCache sample_cache() {
  PointCache cache;
  cache.frame_rate = 24;
  for (int f = 0; f < 5; ++f)
    cache.frames.emplace_back(Eigen::Matrix<float, 7, 3>::Constant(0.25f * static_cast<float>(f)));
  return cache;
}

TEST(PointCache, pc2_and_mdd_read_back_the_same) {
  const TemporaryFolder folder;
  const PointCache cache = sample_cache();
  write_pc2(folder.file("a.pc2"), cache);
  write_mdd(folder.file("a.mdd"), cache);
  EXPECT_EQ(read_pc2(folder.file("a.pc2")).frames, cache.frames);
  EXPECT_EQ(read_mdd(folder.file("a.mdd")).frames, cache.frames);
  EXPECT_NEAR(read_mdd(folder.file("a.mdd")).frame_rate, 24, 1e-4);
}

TEST(PointCache, refuses_headers_that_do_not_match_the_file) {
  const TemporaryFolder folder;
  write_pc2(folder.file("a.pc2"), sample_cache());
  write_mdd(folder.file("a.mdd"), sample_cache());
  const std::string pc2 = read_bytes(folder.file("a.pc2"));
  const std::string mdd = read_bytes(folder.file("a.mdd"));
  EXPECT_REJECTED(parse_pc2(pc2.substr(0, pc2.size() - 4), "a"), "5 frames of 7 points");
  EXPECT_REJECTED(parse_mdd(mdd + "x", "a"), "5 frames of 7 points");
  std::string huge = mdd;
  huge[0] = 0x7f;
  EXPECT_REJECTED(parse_mdd(huge, "a"), "claims");
  EXPECT_REJECTED(parse_pc2("x", "a"), "not a PC2");
  PointCache uneven = sample_cache();
  uneven.frames.back().resize(3, 3);
  message_of([&] { write_pc2(folder.file("b.pc2"), uneven); }, ErrorKind::failure);
}

}  // namespace
}  // namespace phiz
