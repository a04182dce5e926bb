// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "anatomy/preview_head.h"
#include "phiz/anatomy/check_head.h"
#include "phiz/anatomy/thickness_table.h"

namespace phiz {
namespace {

using test::preview_head;

const Gate& gate(const HeadReport& report, const std::string& name) {
  const auto found =
      std::find_if(report.gates.begin(), report.gates.end(), [&](const Gate& g) { return g.name == name; });
  if (found == report.gates.end()) throw std::runtime_error("no gate " + name);
  return *found;
}

TEST(CheckHead, TheBuiltInHeadPassesWhatDoesNotDependOnExpressions) {
  std::vector<std::string> steps;
  const HeadReport report = check_head(preview_head(), [&steps](const std::string& step) { steps.push_back(step); });
  EXPECT_EQ(report.gates.size(), 15U);
  EXPECT_FALSE(steps.empty());
  for (const Gate& g : report.gates) {
    if (g.name == "expressions") continue;
    EXPECT_TRUE(g.holds()) << readable(g);
  }
  EXPECT_FALSE(report.passes());  // it was built without expressions
  EXPECT_EQ(gate(report, "expressions").note.find("missing: eyeBlinkLeft"), 0U);
  EXPECT_EQ(report.muscles.size(), preview_head().muscles.size());
  EXPECT_GT(report.active_share_of_face, 0.15);
  EXPECT_LT(report.active_share_of_face, 0.35);
}

TEST(CheckHead, ABoneThatSticksOutIsMeasured) {
  HeadTemplate broken = preview_head();
  const double before = drawn_bone_depth(broken);
  EXPECT_GT(before, 0.001);
  for (Part& part : broken.parts)
    if (part.name == "mandible") part.mesh.V.col(2).array() += 0.02;
  EXPECT_LT(drawn_bone_depth(broken), 0);
  broken = preview_head();
  const Attachments& held = broken.attachments;
  broken.volume.V.row(held.vertices[0]) += 0.05 * held.normals.row(0);
  EXPECT_LT(simulated_bone_depth(broken), 0);
}

TEST(CheckHead, TurnedFibresAreMeasured) {
  for (const Muscle& m : preview_head().muscles) {
    EXPECT_LT(muscle_figures(preview_head(), m).angle, 25) << m.name;
    if (m.name != "zygomaticusMajorLeft" && m.name != "orbicularisOris") continue;
    Muscle turned = m;
    for (Eigen::Index i = 0; i < turned.direction.rows(); ++i)
      turned.direction.row(i) = Vector3d(turned.direction.row(i)).unitOrthogonal().transpose();
    EXPECT_GT(muscle_figures(preview_head(), turned).angle, 45) << m.name;
  }
}

TEST(CheckHead, AMuscleOutsideTheFleshIsMeasured) {
  Muscle moved = preview_head().muscles[0];
  moved.surface.V.col(2).array() += 0.02;
  EXPECT_LT(muscle_figures(preview_head(), moved).share_in_flesh, 0.5);
}

TEST(CheckHead, TheBiteIsMeasured) {
  const Occlusion bite = occlusion(preview_head());
  ASSERT_TRUE(bite.known);
  EXPECT_NEAR(bite.overbite, 0.0018, 0.0005);
  EXPECT_NEAR(bite.overjet, 0.0023, 0.0008);
  EXPECT_EQ(bite.interpenetration, 0);
  HeadTemplate shut = preview_head();
  for (Part& part : shut.parts)
    if (part.name == "lowerTeeth") part.mesh.V.col(1).array() += 0.004;
  EXPECT_NEAR(occlusion(shut).overbite - bite.overbite, 0.004, 1e-6);
  EXPECT_GT(occlusion(shut).interpenetration, 0.0003);
  std::erase_if(shut.parts, [](const Part& part) { return part.name == "lowerTeeth"; });
  EXPECT_FALSE(occlusion(shut).known);
}

TEST(CheckHead, FleshIsMeasuredOverTheLandmarksOfTheTable) {
  const std::vector<MeasuredThickness> all = measured_thickness(preview_head());
  EXPECT_GE(all.size(), 16U);
  for (const MeasuredThickness& t : all) {
    EXPECT_GT(t.measured, 0.001) << t.name;
    EXPECT_EQ(t.usual, find_usual_thickness(t.name)->mean);
  }
}

TEST(CheckHead, CrossingExpressionsAreCounted) {
  HeadTemplate broken = preview_head();
  MatrixX3d through = MatrixX3d::Zero(broken.skin.V.rows(), 3);
  for (const int v : broken.skin_regions.at("upperLip")) through(v, 1) = -0.02;
  broken.expressions = {{"jawOpen", MatrixX3d::Zero(broken.skin.V.rows(), 3)}, {"mouthClose", through}};
  const std::vector<ExpressionFigures> figures = expression_figures(broken);
  EXPECT_EQ(figures[0].self_intersections, 0U);
  EXPECT_GT(figures[1].self_intersections, 0U);
}

TEST(ThicknessTable, NamesLandmarksWithAndWithoutASide) {
  EXPECT_EQ(find_usual_thickness("gonionLeft"), find_usual_thickness("gonionRight"));
  EXPECT_NE(find_usual_thickness("gonionLeft"), nullptr);
  EXPECT_EQ(find_usual_thickness("nasionLeft"), nullptr);
  EXPECT_EQ(find_usual_thickness("elbow"), nullptr);
  for (const UsualThickness& entry : thickness_table()) {
    EXPECT_GE(entry.deviation, 0.0015);
    EXPECT_GT(entry.mean, 0.002);
    EXPECT_LT(entry.mean, 0.03);
  }
}

}  // namespace
}  // namespace phiz
