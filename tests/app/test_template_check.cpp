// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "command.h"

namespace phiz::testing {
namespace {

TEST(TemplateCheck, SaysEveryGateAndExitsByThem) {
  const ScratchFolder scratch;
  const Outcome outcome = phiz_command({"template", "check", PHIZ_PREVIEW_HEAD, "--json", scratch / "gates.json"});
  const nlohmann::json report = nlohmann::json::parse(read_text(scratch / "gates.json"));
  bool all = true;
  for (const auto& gate : report["gates"]) {
    const std::string name = gate["name"];
    EXPECT_NE(outcome.out.find(name), std::string::npos) << name;
    EXPECT_TRUE(gate["holds"]) << gate;
    all = all && gate["holds"];
  }
  EXPECT_EQ(report["passes"], all);
  EXPECT_EQ(outcome.code, all ? 0 : 1) << outcome.err;
  EXPECT_EQ(report["gates"].size(), 15U);
  EXPECT_EQ(report["muscles"].size(), 37U);
  EXPECT_EQ(report["expression_self_intersections"].size(), 52U);
  EXPECT_TRUE(report["occlusion"]["known"]);
}

TEST(TemplateCheck, RefusesWhatIsNoHead) {
  const Outcome outcome = phiz_command({"template", "check", PHIZ_PERFORMANCE});
  EXPECT_EQ(outcome.code, 3) << outcome.err;
}

}  // namespace
}  // namespace phiz::testing
