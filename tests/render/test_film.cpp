// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "phiz/core/error.h"
#include "phiz/render/film.h"
#include "phiz/render/text.h"

namespace phiz {
namespace {

namespace fs = std::filesystem;

bool has_program(const std::string& name) {
  return std::system((name + " -version >/dev/null 2>&1").c_str()) == 0;
}

std::string output_of(const std::string& command) {
  std::string text;
  std::FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return text;
  std::array<char, 256> buffer{};
  while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) text += buffer.data();
  ::pclose(pipe);
  return text;
}

class Film : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / (std::string("phiz-film-") + test->name());
    fs::remove_all(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string file(const char* name) const { return (folder_ / name).string(); }
  std::size_t files() const {
    return fs::exists(folder_) ? static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), {})) : 0;
  }
  fs::path folder_;
};

TEST_F(Film, HasTheFramesSizeAndRateAskedFor) {
  if (!has_program("ffmpeg") || !has_program("ffprobe")) GTEST_SKIP() << "ffmpeg or ffprobe is not installed";
  FilmWriter film(file("film.mp4"), {.frame_rate = 25});
  for (int i = 0; i < 10; ++i) film.add(blank_image(65, 48, {static_cast<std::uint8_t>(20 * i), 80, 120}));
  film.finish();
  EXPECT_EQ(film.frames(), 10);
  EXPECT_EQ(files(), 1U);
  const std::string probed = output_of(
      "ffprobe -v error -count_frames -select_streams v:0 -show_entries "
      "stream=codec_name,width,height,pix_fmt,r_frame_rate,nb_read_frames -of csv=p=0 '" +
      file("film.mp4") + "'");
  EXPECT_EQ(probed, "h264,66,48,yuv420p,25/1,10\n");
}

TEST_F(Film, AnUnfinishedFilmLeavesNothing) {
  if (!has_program("ffmpeg")) GTEST_SKIP() << "ffmpeg is not installed";
  {
    FilmWriter film(file("film.mp4"));
    film.add(blank_image(64, 48, {1, 2, 3}));
  }
  EXPECT_EQ(files(), 0U);
}

TEST_F(Film, SaysWhenTheEncoderIsMissing) {
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", "/nowhere", 1);
  FilmWriter film(file("film.mp4"));
  std::string message;
  try {
    film.add(blank_image(64, 48, {1, 2, 3}));
  } catch (const Error& error) {
    message = error.what();
    EXPECT_EQ(error.kind(), ErrorKind::failure);
  }
  ::setenv("PATH", path.c_str(), 1);
  EXPECT_NE(message.find("ffmpeg"), std::string::npos) << message;
}

TEST_F(Film, RefusesOtherNamesSizesAndRates) {
  EXPECT_THROW(FilmWriter(file("film.avi")), Error);
  EXPECT_THROW(FilmWriter(file("film.mp4"), {.frame_rate = 0}), Error);
  FilmWriter empty(file("film.mp4"));
  EXPECT_THROW(empty.finish(), Error);
  if (!has_program("ffmpeg")) GTEST_SKIP() << "ffmpeg is not installed";
  FilmWriter film(file("film.mp4"));
  film.add(blank_image(64, 48, {1, 2, 3}));
  EXPECT_THROW(film.add(blank_image(64, 50, {1, 2, 3})), Error);
  EXPECT_THROW(film.add(Image{64, 48, 1, std::vector<std::uint8_t>(64 * 48)}), Error);
}

}  // namespace
}  // namespace phiz
