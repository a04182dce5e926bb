// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "command.h"

namespace phiz::testing {
namespace {

TEST(Usage, HelpAndVersionSucceed) {
  const Outcome help = phiz_command({"--help"});
  EXPECT_EQ(help.code, 0);
  EXPECT_NE(help.out.find("Usage"), std::string::npos);
  const Outcome version = phiz_command({"--version"});
  EXPECT_EQ(version.code, 0);
  EXPECT_EQ(version.out.rfind("phiz ", 0), 0U) << version.out;
}

TEST(Usage, MistakesOnTheCommandLineExitWithTwo) {
  const std::vector<std::vector<std::string>> mistakes = {
      {},
      {"nonsense"},
      {"--threads", "many"},
      {"--threads", "-3"},
      {"template"},
      {"template", "builtin"},
      {"template", "builtin", "--size", "huge", "-o", "x.phiz"},
      {"template", "builtin", "--person", "Ada", "-o", "x.phiz"},
      {"animate"},
      {"animate", "head.phiz"},
      {"export", "take.phiz"},
      {"inspect"},
      {"render", "take.phiz"},
      {"bench"},
      {"bench", "nonsense"},
      {"template", "builtin", "-o", "head.obj"},
      {"animate", "head.phiz", PHIZ_PERFORMANCE, "-o", "take.glb"},
      {"animate", "head.phiz", PHIZ_PERFORMANCE, "-o", "take.phiz", "--frames", "5:2"},
      {"animate", "head.phiz", PHIZ_PERFORMANCE, "-o", "take.phiz", "--frames", "5"},
      {"animate", "head.phiz", PHIZ_PERFORMANCE, "-o", "take.phiz", "--frames", "1.5:3"},
      {"animate", "head.phiz", PHIZ_PERFORMANCE, "-o", "take.phiz", "--frames", "0:301"},
      {"animate", "head.phiz", PHIZ_PERFORMANCE, "-o", "take.phiz", "--fps", "nan"},
      {"export", "take.phiz", "-o", "take.glb", "--tolerance", "nan"},
      {"render", "take.phiz", "-o", "take.jpg"},
      {"render", "take.phiz", "-o", "take.png", "--frame", "-1"},
      {"render", "head.phiz", "-o", "head.png", "--expression", "jawOpen=1e30"},
      {"render", "head.phiz", "-o", "head.png", "--size", "0x0"},
      {"bench", "volumetric", "--frames", "0"},
  };
  for (const auto& words : mistakes) {
    const Outcome outcome = phiz_command(words);
    std::string line;
    for (const auto& word : words) line += " " + word;
    EXPECT_EQ(outcome.code, 2) << "phiz" << line << "\n" << outcome.err;
    EXPECT_FALSE(outcome.err.empty()) << "phiz" << line;
  }
}

TEST(Usage, EveryVerbShowsAnExample) {
  const std::vector<std::vector<std::string>> verbs = {
      {"template", "builtin"}, {"animate"}, {"export"}, {"inspect"}, {"render"}, {"bench", "volumetric"}};
  for (std::vector<std::string> verb : verbs) {
    verb.push_back("--help");
    const Outcome help = phiz_command(verb);
    EXPECT_EQ(help.code, 0) << verb.front();
    EXPECT_NE(help.out.find("Example"), std::string::npos) << "no example in the help of " << verb.front();
    EXPECT_NE(help.out.find("--json"), std::string::npos) << verb.front();
  }
}

}  // namespace
}  // namespace phiz::testing
