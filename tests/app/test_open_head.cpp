// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "command.h"
#include "flesh_depth.h"
#include "phiz/geometry/surface.h"
#include "phiz/io/container.h"
#include "phiz/io/mesh_file.h"
#include "phiz/io/take_file.h"

namespace phiz::testing {
namespace {

const std::string face_kit = "../shared/data/ict_facekit", body_parts = "../shared/data/bodyparts3d";
const std::string recording = "../shared/data/performance-livelink/dao.csv";

enum class Look { solver, geometry };

/// Plays the recording on a head and asks for the bounds of a take, by the solver's measure or by geometry too.
void expect_sound_take(const std::string& head, Look look) {
  const ScratchFolder scratch;
  const std::string path = scratch / "take.phiz";
  const Outcome outcome = phiz_command({"animate", head, recording, "-o", path});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const FleshDepth flesh(load_head_template(head), OwnFlesh::surroundings);
  const TakeReader take(path);
  ASSERT_EQ(take.frames(), 180);
  for (int f = 0; f < take.frames(); ++f) {
    const TakeFrame frame = take.frame(f);
    EXPECT_LE(frame.statistics.penetration, 1e-4) << head << " frame " << f;
    if (look == Look::geometry) {
      EXPECT_LE(flesh.deepest(frame.volume.cast<double>()), 1e-4) << head << " frame " << f;
    }
    EXPECT_LE(std::abs(frame.statistics.volume_change), 0.02) << head << " frame " << f;
    EXPECT_TRUE(frame.statistics.converged) << head << " frame " << f;
  }
}

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
  const PolygonMesh whole = read_mesh(mandible);
  std::filesystem::remove(mandible);
  const auto refuse = [&](const std::string& reason) {
    const Outcome outcome = phiz_command(
        {"template", "build", "--ict", face_kit, "--bodyparts3d", scratch / "parts", "-o", scratch / "open.phiz"});
    EXPECT_EQ(outcome.code, 3) << outcome.err;
    EXPECT_NE(outcome.err.find("FMA52748_mandible.ply"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find(reason), std::string::npos) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(scratch / "open.phiz"));
  };
  write_text(mandible, "ply\nformat ascii 1.0\nelement vertex 3\n");
  refuse("");
  const auto write = [&](const PolygonMesh& mesh) { write_mesh(mandible, triangulate(mesh)); };
  PolygonMesh damaged = whole;
  damaged.faces.resize(whole.faces.size() / 2);
  write(damaged);
  refuse("incomplete");
  damaged = whole;
  for (std::vector<int>& face : damaged.faces) std::reverse(face.begin(), face.end());
  write(damaged);
  refuse("inside out");
  damaged = whole;
  damaged.V.col(0).array() += 1000;
  write(damaged);
  refuse("far away");
}

TEST(OpenHead, AnInterruptedBuildLeavesNothingBehind) {
  if (!std::filesystem::exists(face_kit) || !std::filesystem::exists(body_parts))
    GTEST_SKIP() << "no open data in ../shared/data";
  for (const int signal : {SIGINT, SIGTERM}) {
    const ScratchFolder scratch;
    setenv("PHIZ_CACHE", (scratch / "cache").c_str(), 1);
    std::filesystem::create_directories(scratch / "out");
    const auto start = std::chrono::steady_clock::now();
    const Outcome stopped = phiz_command({"template", "build", "--ict", face_kit, "--bodyparts3d", body_parts, "--size",
                                          "preview", "-o", scratch / "out/a.phiz"},
                                         [&](pid_t process) {
                                           if (std::chrono::steady_clock::now() - start > std::chrono::seconds(5))
                                             kill(process, signal);
                                         });
    EXPECT_NE(stopped.code, 0);
    EXPECT_TRUE(std::filesystem::is_empty(scratch / "out"));
    EXPECT_FALSE(std::filesystem::exists(scratch / "cache"));
  }
}

TEST(OpenHead, PassesItsGatesAndPlaysTheRecording) {
  if (!std::filesystem::exists(face_kit) || !std::filesystem::exists(body_parts))
    GTEST_SKIP() << "no open data in ../shared/data";
  const ScratchFolder scratch;
  setenv("PHIZ_CACHE", (scratch / "cache").c_str(), 1);
  const Outcome built = phiz_command(
      {"template", "build", "--ict", face_kit, "--bodyparts3d", body_parts, "--fresh", "-o", scratch / "open.phiz"});
  ASSERT_EQ(built.code, 0) << built.err;
  const Outcome checked = phiz_command({"template", "check", scratch / "open.phiz"});
  EXPECT_EQ(checked.code, 0) << checked.out << checked.err;
  if (!std::filesystem::exists(recording)) GTEST_SKIP() << "no " << recording;
  expect_sound_take(scratch / "open.phiz", Look::geometry);
}

TEST(OpenHead, PreviewAndItsPeoplePlayTheRecording) {
  if (!std::filesystem::exists(face_kit) || !std::filesystem::exists(body_parts) || !std::filesystem::exists(recording))
    GTEST_SKIP() << "no open data in ../shared/data";
  const ScratchFolder scratch;
  setenv("PHIZ_CACHE", (scratch / "cache").c_str(), 1);
  const std::string open = scratch / "open.phiz";
  const Outcome built = phiz_command(
      {"template", "build", "--ict", face_kit, "--bodyparts3d", body_parts, "--size", "preview", "-o", open});
  ASSERT_EQ(built.code, 0) << built.err;
  const Outcome checked = phiz_command({"template", "check", open});
  EXPECT_EQ(checked.code, 0) << checked.out << checked.err;
  const std::string again = scratch / "again.phiz";
  const Outcome rebuilt = phiz_command({"--threads", "1", "template", "build", "--ict", face_kit, "--bodyparts3d",
                                        body_parts, "--size", "preview", "--fresh", "-o", again});
  ASSERT_EQ(rebuilt.code, 0) << rebuilt.err;
  EXPECT_TRUE(read_text(open) == read_text(again)) << "the same bytes for any number of threads";
  std::vector<std::string> heads{open};
  for (const char* seed : {"1", "2", "3"}) {
    heads.push_back(scratch / (std::string("person") + seed + ".phiz"));
    const Outcome person = phiz_command({"template", "person", open, "--seed", seed, "-o", heads.back()});
    ASSERT_EQ(person.code, 0) << person.err;
  }
  for (const std::string& head : heads) expect_sound_take(head, Look::solver);
  const Outcome nobody = phiz_command({"template", "person", heads.back(), "-o", scratch / "nobody.phiz"});
  EXPECT_EQ(nobody.code, 3) << nobody.err;
  EXPECT_NE(nobody.err.find("no model of people"), std::string::npos) << nobody.err;
}

}  // namespace
}  // namespace phiz::testing
