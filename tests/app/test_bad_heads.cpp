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

}  // namespace
}  // namespace phiz::testing
