// SPDX-License-Identifier: GPL-3.0-or-later
// Mixtures of expressions that nobody tuned for.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "command.h"
#include "flesh_depth.h"
#include "phiz/anatomy/expression_names.h"
#include "phiz/core/random.h"
#include "phiz/geometry/spatial_query.h"
#include "phiz/io/container.h"
#include "phiz/io/take_file.h"

namespace phiz::testing {
namespace {

Eigen::Index column_of(const std::string& name) {
  return std::find(expression_names.begin(), expression_names.end(), name) - expression_names.begin();
}

/// Frames at 30 Hz of weights, one column per expression.
Performance still_headed(const MatrixXd& weights) {
  Performance performance;
  performance.expressions.assign(expression_names.begin(), expression_names.end());
  performance.weights = weights;
  const Eigen::Index n = weights.rows();
  performance.time = VectorXd::LinSpaced(n, 0, static_cast<double>(n - 1) / 30);
  performance.frame_rate = 30;
  performance.head = performance.left_eye = performance.right_eye = MatrixX3d::Zero(n, 3);
  return performance;
}

/// Poses of two to seven expressions of the lower face, each reached and held in ten frames.
Performance random_mouths(int poses, std::uint64_t seed) {
  std::vector<Eigen::Index> pool;
  for (std::size_t e = 0; e < expression_names.size(); ++e)
    for (const char* part : {"mouth", "jaw", "cheek", "tongue"})
      if (std::string(expression_names[e]).starts_with(part)) pool.push_back(static_cast<Eigen::Index>(e));
  constexpr int frames = 10;
  const auto count = static_cast<Eigen::Index>(expression_names.size());
  MatrixXd weights = MatrixXd::Zero(poses * frames, count);
  Random random(seed);
  VectorXd from = VectorXd::Zero(count);
  for (int pose = 0; pose < poses; ++pose) {
    VectorXd to = VectorXd::Zero(count);
    for (std::uint32_t k = 2 + random.below(6); k > 0; --k)
      to[pool[random.below(static_cast<std::uint32_t>(pool.size()))]] = random.uniform(0.2, 1);
    double& close = to[column_of("mouthClose")];  // closes what the jaw has opened
    close = std::min(close, to[column_of("jawOpen")]);
    for (int f = 0; f < frames; ++f) {
      const double t = std::min(1.0, (f + 1) / 8.0);
      weights.row(pose * frames + f) = (from + t * t * (3 - 2 * t) * (to - from)).transpose();
    }
    from = to;
  }
  return still_headed(weights);
}

/// How deep the vertices lie within the teeth, at the most, metres.
double depth_in_teeth(const HeadTemplate& head, const MatrixX3d& V, const JawPose& pose, const VectorXi& vertices) {
  static const SurfaceQuery upper(find_part(head, "upperTeeth")->mesh), lower(find_part(head, "lowerTeeth")->mesh);
  const Eigen::Isometry3d to_rest = jaw_transform(head.jaw, pose).inverse();
  double most = 0;
  for (const int v : vertices) {
    const Vector3d p = V.row(v);
    if (upper.closest_point_within(p, 0.003)) most = std::max(most, -upper.signed_distance(p));
    if (lower.closest_point_within(to_rest * p, 0.003)) most = std::max(most, -lower.signed_distance(to_rest * p));
  }
  return most;
}

TEST(RandomPoses, ConvergeAndNoLipEntersFleshOrTeeth) {
  const ScratchFolder scratch;
  save(scratch / "poses.phiz", random_mouths(16, 1));
  const Outcome outcome =
      phiz_command({"animate", PHIZ_PREVIEW_MODEL, scratch / "poses.phiz", "-o", scratch / "take.phiz", "--json", "-"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto report = nlohmann::json::parse(outcome.out);
  for (const auto& frame : report.at("statistics")) {
    EXPECT_TRUE(frame.at("converged").get<bool>()) << frame;
    EXPECT_LE(frame.at("penetration_mm").get<double>(), 0.1) << frame;
    EXPECT_LE(std::abs(frame.at("volume_change").get<double>()), 0.03) << frame;  // some mixtures ask for 2 %
  }
  // The same by geometry alone.
  const HeadTemplate head = load_head_template(PHIZ_PREVIEW_HEAD);
  const FleshDepth flesh(head, OwnFlesh::tets);
  std::vector<int> mouth;
  for (const ContactRegion& region : head.contact_regions)
    if (region.name.find("Lip") != std::string::npos || region.name.find("Cheek") != std::string::npos)
      mouth.insert(mouth.end(), region.vertices.begin(), region.vertices.end());
  const VectorXi vertices = VectorXi::Map(mouth.data(), static_cast<Eigen::Index>(mouth.size()));
  ASSERT_GT(vertices.size(), 100);
  const auto deepest = [&](const std::string& path) {
    const TakeReader take(path);
    double most = 0;
    for (int f = 0; f < take.frames(); ++f) {
      const TakeFrame frame = take.frame(f);
      const MatrixX3d V = frame.volume.cast<double>();
      most = std::max({most, flesh.deepest(V), depth_in_teeth(head, V, frame.jaw, vertices)});
    }
    return most;
  };
  EXPECT_LE(deepest(scratch / "take.phiz"), 1e-4);
  const Outcome without = phiz_command(
      {"animate", PHIZ_PREVIEW_MODEL, scratch / "poses.phiz", "-o", scratch / "without.phiz", "--no-contact"});
  ASSERT_EQ(without.code, 0) << without.err;
  EXPECT_GT(deepest(scratch / "without.phiz"), 5e-4) << "the poses press lips together, or this test says nothing";
}

/// How far the lips stand apart in the middle two thirds of the mouth, at the most, metres.
double parting(const HeadTemplate& head, const MatrixX3d& skin) {
  const VectorXi &above = head.skin_regions.at("loop:upperLipLine"), &below = head.skin_regions.at("loop:lowerLipLine");
  const double half = 0.67 * head.skin.V(above, 0).cwiseAbs().maxCoeff();
  double most = 0;
  for (const int a : above) {
    if (std::abs(head.skin.V(a, 0)) > half) continue;
    Eigen::Index partner = 0;
    (head.skin.V(below, Eigen::all).rowwise() - head.skin.V.row(a)).rowwise().squaredNorm().minCoeff(&partner);
    most = std::max(most, (skin.row(a) - skin.row(below[partner])).norm());
  }
  return most;
}

TEST(MouthClose, BringsTheLipsOfAnOpenJawTogether) {
  const ScratchFolder scratch;
  MatrixXd weights = MatrixXd::Zero(6, static_cast<Eigen::Index>(expression_names.size()));
  weights.col(column_of("jawOpen")) << 0.1, 0.25, 0.5, 0.75, 1, 0.5;
  weights.col(column_of("mouthClose")) << 0.1, 0.25, 0.5, 0.75, 1, 0;
  save(scratch / "close.phiz", still_headed(weights));
  const Outcome outcome =
      phiz_command({"animate", PHIZ_PREVIEW_MODEL, scratch / "close.phiz", "-o", scratch / "take.phiz"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const HeadTemplate head = load_head_template(PHIZ_PREVIEW_HEAD);
  const TakeReader take(scratch / "take.phiz");
  for (int f = 0; f < 5; ++f) EXPECT_LE(parting(head, take.frame(f).skin.cast<double>()), 0.002) << "frame " << f;
  EXPECT_GE(parting(head, take.frame(5).skin.cast<double>()), 0.01) << "the jaw alone parts them";
}

}  // namespace
}  // namespace phiz::testing
