// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "command.h"

namespace phiz::testing {
namespace {

const std::string face_kit = "../shared/data/ict_facekit", body_parts = "../shared/data/bodyparts3d";

TEST(OpenHead, MissingDataIsNamedAndNothingIsLeftBehind) {
  const ScratchFolder scratch;
  std::filesystem::create_directories(scratch / "empty");
  const std::string head = scratch / "open.phiz";
  const Outcome none =
      phiz_command({"template", "build", "--ict", scratch / "nowhere", "--bodyparts3d", scratch / "empty", "-o", head});
  EXPECT_EQ(none.code, 3) << none.err;
  EXPECT_NE(none.err.find("no such folder"), std::string::npos) << none.err;
  const Outcome empty =
      phiz_command({"template", "build", "--ict", scratch / "empty", "--bodyparts3d", scratch / "empty", "-o", head});
  EXPECT_EQ(empty.code, 3) << empty.err;
  EXPECT_NE(empty.err.find("FMA52734 (frontal bone)"), std::string::npos) << empty.err;
  EXPECT_FALSE(std::filesystem::exists(head));
}

TEST(OpenHead, DamagedPartsAreNamed) {
  if (!std::filesystem::exists(body_parts)) GTEST_SKIP() << "no BodyParts3D in " << body_parts;
  const ScratchFolder scratch;
  std::filesystem::create_directories(scratch / "parts");
  for (const auto& entry : std::filesystem::recursive_directory_iterator(body_parts))
    if (entry.path().extension() == ".ply")
      std::filesystem::create_symlink(std::filesystem::absolute(entry.path()),
                                      std::filesystem::path(scratch / "parts") / entry.path().filename());
  const std::string mandible = scratch / "parts/FMA52748_mandible.ply";
  std::filesystem::remove(mandible);
  write_text(mandible, "ply\nformat ascii 1.0\nelement vertex 3\n");
  const Outcome outcome = phiz_command(
      {"template", "build", "--ict", face_kit, "--bodyparts3d", scratch / "parts", "-o", scratch / "open.phiz"});
  EXPECT_EQ(outcome.code, 3) << outcome.err;
  EXPECT_NE(outcome.err.find("FMA52748_mandible.ply"), std::string::npos) << outcome.err;
}

TEST(OpenHead, IsBuiltFromOpenDataAndPassesItsGates) {
  if (!std::filesystem::exists(face_kit) || !std::filesystem::exists(body_parts))
    GTEST_SKIP() << "no open data in ../shared/data";
  const ScratchFolder scratch;
  setenv("PHIZ_CACHE", (scratch / "cache").c_str(), 1);
  const Outcome built = phiz_command(
      {"template", "build", "--ict", face_kit, "--bodyparts3d", body_parts, "--fresh", "-o", scratch / "open.phiz"});
  ASSERT_EQ(built.code, 0) << built.err;
  const Outcome checked = phiz_command({"template", "check", scratch / "open.phiz"});
  EXPECT_EQ(checked.code, 0) << checked.out << checked.err;
}

}  // namespace
}  // namespace phiz::testing
