// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <string>

#include "command.h"

namespace phiz::testing {
namespace {

const std::string triangle = "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\n";
const std::string csv_header = "Timecode,BlendShapeCount,JawOpen,HeadYaw\n";

struct BrokenFile {
  std::string name;
  std::string text;
  std::string says;  ///< a word that the message must contain, so that the user finds the place
};

std::ostream& operator<<(std::ostream& out, const BrokenFile& file) {
  return out << file.name;
}

class BadFile : public ::testing::TestWithParam<BrokenFile> {};

TEST_P(BadFile, IsRefusedWithPlaceAndReason) {
  const ScratchFolder scratch;
  const std::string path = scratch / GetParam().name;
  write_text(path, GetParam().text);
  const Outcome outcome = phiz_command({"inspect", path});
  EXPECT_EQ(outcome.code, 3) << outcome.out << outcome.err;
  EXPECT_NE(outcome.err.find(GetParam().name), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find(GetParam().says), std::string::npos) << outcome.err;
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, BadFile,
    ::testing::Values(
        BrokenFile{"empty.obj", "", "obj"}, BrokenFile{"nan.obj", triangle + "v nan 0 0\nf 1 2 3\n", ":4"},
        BrokenFile{"huge-index.obj", triangle + "f 1 2 99999999999\n", ":4"},
        BrokenFile{"letters.obj", "v 0 zero 0\n", ":1"},
        BrokenFile{"claims.ply",
                   "ply\nformat ascii 1.0\nelement vertex 1000000000000\nproperty float x\nproperty float "
                   "y\nproperty float z\nend_header\n0 0 0\n",
                   "ply"},
        BrokenFile{"cut.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0", "stl"},
        BrokenFile{"cut.glb", std::string("glTF\x02\0\0\0\xff\0\0\0", 12), "glb"},
        BrokenFile{"millimetres.obj", "v 0 0 0\nv 180 0 0\nv 0 240 0\nf 1 2 3\n", "0.001"},
        BrokenFile{"empty.csv", "", "csv"}, BrokenFile{"rows-missing.csv", csv_header, "csv"},
        BrokenFile{"nan.csv", csv_header + "00:00:00:00.0,61,nan,0\n", ":2"},
        BrokenFile{"percent.csv", csv_header + "00:00:00:00.0,61,87,0\n00:00:00:01.0,61,55,0\n", "percent"},
        BrokenFile{"degrees.csv", csv_header + "00:00:00:00.0,61,0.2,35\n00:00:00:01.0,61,0.2,40\n", "degrees"},
        BrokenFile{"twice.csv", "Timecode,JawOpen,jawOpen\n00:00:00:00.0,0,0\n", "twice"},
        BrokenFile{"cut-row.csv", csv_header + "00:00:00:00.0,61\n", ":2"},
        BrokenFile{"backward.csv", csv_header + "00:00:01:00.0,61,0,0\n00:00:00:00.0,61,0,0\n", ":3"},
        BrokenFile{"milliseconds.csv", "time,jawOpen\n0,0\n33,0\n67,0\n", "1000"},
        BrokenFile{"utf16.csv", std::string("\xff\xfeJ\0a\0w\0", 8), "UTF-8"}, BrokenFile{"empty.phiz", "", "empty"},
        BrokenFile{"text.phiz", "this is no container", "phiz"}, BrokenFile{"text.png", "this is no picture", "png"},
        BrokenFile{"unknown.xyz", "?", "xyz"}),
    [](const ::testing::TestParamInfo<BrokenFile>& parameter) {
      std::string name = parameter.param.name;
      for (char& c : name)
        if (c == '.' || c == '-') c = '_';
      return name;
    });

TEST(BadInput, AMissingFileExitsWithThreeAndNamesIt) {
  const Outcome outcome = phiz_command({"inspect", "no-such-file.phiz"});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_NE(outcome.err.find("no-such-file.phiz"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace phiz::testing
