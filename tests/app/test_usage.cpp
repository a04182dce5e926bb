// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <utility>

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
      {"render", "take.phiz", "-o", "film.mp4", "--sheet"},
      {"render", "head.phiz", "-o", "head.png", "--peel", "x=0"},
      {"render", "head.phiz", "-o", "head.png", "--style", "muscles", "--peel", "left"},
      {"render", "head.phiz", "-o", "head.png", "--style", "skin", "--muscle", "masseter"},
      {"render", "head.phiz", "-o", "film.mp4", "--all-expressions"},
      {"bench", "volumetric", "--frames", "0"},
      {"bench", "forward", "--frames", "0"},
      {"bench", "torture", "--poses", "-1"},
  };
  for (const auto& words : mistakes) {
    const Outcome outcome = phiz_command(words);
    std::string line;
    for (const auto& word : words) line += " " + word;
    EXPECT_EQ(outcome.code, 2) << "phiz" << line << "\n" << outcome.err;
    EXPECT_FALSE(outcome.err.empty()) << "phiz" << line;
  }
}

TEST(Usage, AMistakeIsNamedInOneLineWithWhatWouldBeRight) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> mistakes = {
      {{"animat", "head.phiz", PHIZ_PERFORMANCE, "-o", "take.phiz"}, "no 'phiz animat'; did you mean 'animate'?"},
      {{"nonsense"},
       "no 'phiz nonsense'; known: template, animate, simulate, export, inspect, render, bench; see phiz --help"},
      {{"template", "bulitin", "-o", "x.phiz"}, "no 'phiz template bulitin'; did you mean 'builtin'?"},
      {{"template"}, "phiz template needs one of these words: build, builtin, person, check; see phiz template --help"},
      {{"template", "builtin", "--sise=preview", "-o", "x.phiz"}, "no option '--sise'; did you mean '--size'?"},
      {{"animate", "head.phiz", PHIZ_PERFORMANCE, "--ouptut", "take.phiz"}, "did you mean '--output'?"},
      {{"animate", "head.phiz", PHIZ_PERFORMANCE, "-o", "take.phiz", "--thread", "2"}, "did you mean '--threads'?"},
      {{"--thread", "2"}, "phiz has no option '--thread'; did you mean '--threads'?"},
      {{"inspect", "head.phiz", "--unheard-of"}, "phiz inspect has no option '--unheard-of'; see phiz inspect --help"},
      {{"--threads", "many"}, "'many' is not a number from 0 to 1024"},
      {{"--threads"}, "--threads"},
      {{"animate", "head.phiz", "-o", "take.phiz"}, "PERFORMANCE is required; see phiz animate --help"},
      {{"animate", "head.phiz", PHIZ_PERFORMANCE}, "--output is required; see phiz animate --help"},
      {{"animate", "head.phiz", PHIZ_PERFORMANCE, "more.csv", "-o", "take.phiz"},
       "'more.csv' is one argument too many"},
      {{"inspect", "a.phiz", "b.phiz"}, "'b.phiz' is one argument too many for phiz inspect; see phiz inspect --help"},
  };
  for (const auto& [words, message] : mistakes) {
    const Outcome outcome = phiz_command(words);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_EQ(outcome.err.rfind("phiz: ", 0), 0U) << outcome.err;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << "expected: " << message << "\nsaid: " << outcome.err;
    EXPECT_EQ(outcome.err.find('\n'), outcome.err.size() - 1) << outcome.err;
    EXPECT_TRUE(outcome.out.empty()) << outcome.out;
  }
}

TEST(Usage, WithoutAnyWordTheHelpIsShown) {
  const Outcome outcome = phiz_command({});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("Usage: phiz"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("phiz needs one of these words: template,"), std::string::npos) << outcome.err;
}

TEST(Usage, EveryVerbShowsAnExample) {
  const std::vector<std::vector<std::string>> verbs = {
      {"template", "builtin"}, {"animate"},          {"export"},          {"inspect"}, {"render"},
      {"bench", "volumetric"}, {"bench", "forward"}, {"bench", "torture"}};
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
