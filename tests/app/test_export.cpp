// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "command.h"
#include "phiz/io/take_file.h"

namespace phiz::testing {
namespace {

constexpr int short_frames = 6;

void export_take(const std::string& path, const std::string& take = PHIZ_PREVIEW_TAKE) {
  const Outcome outcome = phiz_command({"export", take, "-o", path});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
}

/// The JSON chunk of a GLB file.
nlohmann::json glb_json(const std::string& path) {
  const std::string bytes = read_text(path);
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 12, sizeof length);
  return nlohmann::json::parse(bytes.substr(20, length));
}

TEST(Export, GlbHasSeparateNodesForSkinEyesTeethAndBones) {
  const ScratchFolder scratch;
  export_take(scratch / "take.glb", PHIZ_SHORT_TAKE);
  std::vector<std::string> names;
  const nlohmann::json gltf = glb_json(scratch / "take.glb");
  for (const auto& node : gltf.at("nodes")) names.push_back(node.value("name", ""));
  for (const std::string name :
       {"head", "skin", "jaw", "skull", "mandible", "upperTeeth", "lowerTeeth", "leftEye", "rightEye"})
    EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
}

TEST(Export, GlbPassesTheKhronosValidator) {
  if (!program_exists("node") || !std::filesystem::exists(PHIZ_VALIDATOR "/node_modules/gltf-validator"))
    GTEST_SKIP() << "gltf-validator is not installed: scripts/setup --all";
  const ScratchFolder scratch;
  export_take(scratch / "take.glb");
  const Outcome outcome = run_program({"node", "tests/app/check_glb.mjs", scratch / "take.glb", PHIZ_VALIDATOR});
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
}

TEST(Export, GlbPlaysInBlender) {
  if (!program_exists("blender")) GTEST_SKIP() << "Blender is not installed: scripts/setup --all";
  const ScratchFolder scratch;
  export_take(scratch / "take.glb");
  const Outcome outcome = run_program({"blender", "-b", "--factory-startup", "--python-exit-code", "1", "--python",
                                       std::filesystem::absolute("tests/app/check_glb_blender.py").string(), "--",
                                       scratch / "take.glb", "30"});
  ASSERT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  const std::size_t line = outcome.out.find("PHIZ ");
  ASSERT_NE(line, std::string::npos) << outcome.out;
  const auto seen = nlohmann::json::parse(outcome.out.substr(line + 5, outcome.out.find('\n', line) - line - 5));
  const nlohmann::json gltf = glb_json(scratch / "take.glb");
  int skin_vertices = 0;
  for (const auto& node : gltf.at("nodes"))
    if (node.value("name", "") == "skin")
      for (const auto& primitive : gltf.at("meshes").at(node.at("mesh").get<std::size_t>()).at("primitives"))
        skin_vertices += gltf.at("accessors")
                             .at(primitive.at("attributes").at("POSITION").get<std::size_t>())
                             .at("count")
                             .get<int>();
  EXPECT_EQ(seen.at("frames"), 300);
  EXPECT_EQ(seen.at("skin_vertices"), skin_vertices);
  EXPECT_GT(seen.at("moving_vertices").get<int>(), skin_vertices / 2);
  EXPECT_GT(seen.at("largest_travel").get<double>(), 0.005);
  EXPECT_TRUE(seen.at("finite").get<bool>());
}

TEST(Export, PointCachesHoldEveryVertexOfEveryFrame) {
  const ScratchFolder scratch;
  const auto vertices = static_cast<std::uintmax_t>(TakeReader(PHIZ_SHORT_TAKE).head().skin.V.rows());
  export_take(scratch / "take.pc2", PHIZ_SHORT_TAKE);
  EXPECT_EQ(std::filesystem::file_size(scratch / "take.pc2"), 32 + short_frames * vertices * 12);
  export_take(scratch / "take.mdd", PHIZ_SHORT_TAKE);
  EXPECT_EQ(std::filesystem::file_size(scratch / "take.mdd"), 8 + short_frames * 4 + short_frames * vertices * 12);
}

TEST(Export, ObjSequenceHasOneFilePerFrame) {
  const ScratchFolder scratch;
  export_take(scratch / "sequence/skin.obj", PHIZ_SHORT_TAKE);
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(scratch / "sequence"))
    files += entry.path().extension() == ".obj" ? 1 : 0;
  EXPECT_EQ(files, short_frames);
}

}  // namespace
}  // namespace phiz::testing
