// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "command.h"

namespace phiz::testing {
namespace {

TEST(BadHead, ATruncatedHeadIsRefusedWhereverItEnds) {
  const ScratchFolder scratch;
  const std::string head = read_text(PHIZ_PREVIEW_HEAD);
  ASSERT_FALSE(head.empty()) << "run through ctest, which makes " PHIZ_PREVIEW_HEAD " first";
  for (const double share : {0.0, 0.01, 0.3, 0.7, 0.999}) {
    const std::string path = scratch / "cut.phiz";
    write_text(path, head.substr(0, static_cast<std::size_t>(share * static_cast<double>(head.size()))));
    const Outcome outcome = phiz_command({"animate", path, PHIZ_PERFORMANCE, "-o", scratch / "take.phiz"});
    EXPECT_EQ(outcome.code, 3) << share << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(scratch / "take.phiz"));
  }
}

TEST(BadHead, FlippedBytesInAHeadAreRefused) {
  const ScratchFolder scratch;
  const std::string head = read_text(PHIZ_PREVIEW_HEAD);
  ASSERT_FALSE(head.empty()) << "run through ctest, which makes " PHIZ_PREVIEW_HEAD " first";
  for (std::size_t part = 1; part < 8; ++part) {
    std::string damaged = head;
    damaged[part * head.size() / 8] = static_cast<char>(damaged[part * head.size() / 8] ^ 0x55);
    write_text(scratch / "damaged.phiz", damaged);
    const Outcome outcome = phiz_command({"inspect", scratch / "damaged.phiz"});
    EXPECT_EQ(outcome.code, 3) << "byte " << part << "/8: " << outcome.err;
  }
}

TEST(BadHead, AWrongKindOfFileIsNamed) {
  const ScratchFolder scratch;
  const Outcome swapped = phiz_command({"animate", PHIZ_PERFORMANCE, PHIZ_PREVIEW_HEAD, "-o", scratch / "take.phiz"});
  EXPECT_EQ(swapped.code, 3) << swapped.err;
  const Outcome no_take = phiz_command({"export", PHIZ_PERFORMANCE, "-o", scratch / "x.glb"});
  EXPECT_EQ(no_take.code, 3) << no_take.err;
}

TEST(BadHead, AnOutputThatCannotBeWrittenIsAFailure) {
  const Outcome outcome = phiz_command({"export", PHIZ_PREVIEW_HEAD, "-o", "/proc/no/head.obj"});
  EXPECT_EQ(outcome.code, 1) << outcome.err;
}

TEST(BadHead, AnOutputOverAnInputIsRefusedAndTheInputKept) {
  const ScratchFolder scratch;
  const std::string head = scratch / "head.phiz";
  std::filesystem::copy_file(PHIZ_PREVIEW_HEAD, head);
  const Outcome outcome = phiz_command({"animate", head, PHIZ_PERFORMANCE, "-o", head});
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_TRUE(read_text(head) == read_text(PHIZ_PREVIEW_HEAD));
}

TEST(BadHead, AFolderInThePlaceOfTheOutputIsAFailureThatLeavesNothing) {
  const ScratchFolder scratch;
  std::filesystem::create_directory(scratch / "take.phiz");
  const Outcome outcome = phiz_command({"animate", PHIZ_PREVIEW_HEAD, PHIZ_PERFORMANCE, "-o", scratch / "take.phiz"});
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(scratch / "take.phiz.part"));
}

TEST(BadHead, AnUnknownExpressionIsAMistakeOfTheCommandLine) {
  const ScratchFolder scratch;
  const Outcome outcome =
      phiz_command({"render", PHIZ_PREVIEW_HEAD, "-o", scratch / "head.png", "--expression", "jawOpne=1"});
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_NE(outcome.err.find("jawOpne"), std::string::npos) << outcome.err;
}

TEST(BadMesh, AVertexBeyondTheReachOfTheRayTracerIsRefused) {
  const ScratchFolder scratch;
  for (const std::string far : {"1e30", "1e200"}) {
    write_text(scratch / "far.obj", "v 0 0 0\nv 0.1 0 0\nv 0 " + far + " 0\nf 1 2 3\n");
    const Outcome outcome = phiz_command({"render", scratch / "far.obj", "-o", scratch / "far.png", "--size", "32x32"});
    EXPECT_EQ(outcome.code, 3) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(scratch / "far.png"));
  }
}

}  // namespace
}  // namespace phiz::testing
