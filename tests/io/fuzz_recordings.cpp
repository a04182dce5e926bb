// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "io/mutate.h"
#include "io/sample_nouns.h"
#include "io/temporary_folder.h"
#include "phiz/io/file_bytes.h"
#include "phiz/io/gltf.h"
#include "phiz/io/live_link.h"
#include "phiz/io/png.h"
#include "phiz/io/point_cache.h"
#include "phiz/io/take_gltf.h"

namespace phiz {
namespace {

TEST(FuzzLiveLink, every_mutation_is_read_or_refused) {
  const TemporaryFolder folder;
  write_live_link(folder.file("a.csv"), sample_performance());
  const std::string semicolons = "time;jawOpen;\"mouthSmile_L\";HeadYaw\n0,5;0;0,25;0\n0,6;1;0,5;0,1\n0,7;0;1;0,2\n";
  expect_survives({read_bytes(folder.file("a.csv")), semicolons}, 4000, [](const std::string& text) {
    const Performance p = parse_live_link(text, "fuzz").performance;
    validate(p, "fuzz");
  });
}

TEST(FuzzPng, every_mutation_is_read_or_refused) {
  const Image image{9, 7, 3, std::vector<std::uint8_t>(9 * 7 * 3, 100)};
  const DeepImage deep{9, 7, 1, std::vector<std::uint16_t>(9 * 7, 1000)};
  expect_survives({png_bytes(image), png_bytes(deep)}, 3000, [](const std::string& bytes) {
    const Image eight = parse_png(bytes, "fuzz");
    const DeepImage sixteen = parse_deep_png(bytes, "fuzz");
    EXPECT_EQ(eight.pixels.size(), sixteen.pixels.size());
  });
}

TEST(FuzzPointCache, every_mutation_is_read_or_refused) {
  const TemporaryFolder folder;
  PointCache cache;
  for (int f = 0; f < 4; ++f) cache.frames.emplace_back(Eigen::Matrix<float, 5, 3>::Constant(static_cast<float>(f)));
  write_pc2(folder.file("a.pc2"), cache);
  write_mdd(folder.file("a.mdd"), cache);
  expect_survives({read_bytes(folder.file("a.pc2"))}, 4000, [](const std::string& bytes) { parse_pc2(bytes, "fuzz"); });
  expect_survives({read_bytes(folder.file("a.mdd"))}, 4000, [](const std::string& bytes) { parse_mdd(bytes, "fuzz"); });
}

TEST(FuzzGltf, every_mutation_is_read_or_refused) {
  const TemporaryFolder folder;
  export_take_gltf(sample_take(4, 3), folder.file("a.glb"));
  Take still = sample_take(3, 2);
  still.parts.clear();  // keeps the eyes' texture out of the seed
  export_take_gltf(still, folder.file("a.gltf"));
  const std::string json_heavy = read_bytes(folder.file("a.gltf"));
  expect_survives({read_bytes(folder.file("a.glb")), json_heavy}, 4000, [](const std::string& bytes) {
    const GltfScene scene = parse_gltf(bytes, "fuzz");
    world_transforms(scene);
    flattened(scene);
  });
}

}  // namespace
}  // namespace phiz
