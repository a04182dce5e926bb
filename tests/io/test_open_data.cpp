// SPDX-License-Identifier: GPL-3.0-or-later
/// Files of others, where the open data lies beside the checkout.
#include <gtest/gtest.h>

#include <filesystem>

#include "phiz/anatomy/expression_names.h"
#include "phiz/io/live_link.h"
#include "phiz/io/mesh_file.h"
#include "phiz/io/obj.h"

namespace phiz {
namespace {

class OpenData : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(data_)) GTEST_SKIP() << "the open data is not beside the checkout";
  }
  std::string file(const std::string& name) const { return (data_ / name).string(); }
  std::filesystem::path data_ = "../shared/data";
};

TEST_F(OpenData, heads_and_bodies_are_read) {
  const PolygonMesh face = read_obj(file("ict_facekit/generic_neutral_mesh.obj"));
  EXPECT_GT(face.faces.size(), 20000u);
  EXPECT_EQ(suspect_unit(face.V).name, "centimetres");
  const PolygonMesh body = read_obj(file("makehuman/base.obj"));
  EXPECT_GT(body.groups.size(), 10u);
}

TEST_F(OpenData, the_real_recording_is_read_with_consistent_signs) {
  const LiveLinkRecording recording = read_live_link(file("performance-livelink/dao.csv"));
  const Performance& p = recording.performance;
  ASSERT_EQ(p.time.size(), 180);
  EXPECT_EQ(p.frame_rate, 60);
  EXPECT_EQ(p.time[0], 0);
  EXPECT_NEAR(p.time[179], 3.1, 0.01);
  EXPECT_EQ(recording.notes.size(), 1u);  // one gap
  const auto column = [&p](std::string_view name) {
    const auto place = std::find(expression_names.begin(), expression_names.end(), name);
    return VectorXd(p.weights.col(place - expression_names.begin()));
  };
  EXPECT_NEAR(column("jawOpen").maxCoeff(), 0.78, 0.01);
  // Looking toward the nose turns the left eye to the person's right: negative yaw. Looking down is positive pitch.
  const auto correlation = [](VectorXd a, VectorXd b) {
    a.array() -= a.mean();
    b.array() -= b.mean();
    return a.dot(b) / (a.norm() * b.norm());
  };
  EXPECT_LT(correlation(p.left_eye.col(0), column("eyeLookInLeft")), -0.9);
  EXPECT_GT(correlation(p.left_eye.col(1), column("eyeLookDownLeft")), 0.9);
}

}  // namespace
}  // namespace phiz
