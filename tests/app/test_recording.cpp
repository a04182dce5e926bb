// SPDX-License-Identifier: GPL-3.0-or-later
// The standard head plays a real recording (label `data`).
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>

#include "command.h"
#include "flesh_depth.h"
#include "phiz/io/container.h"
#include "phiz/io/take_file.h"

namespace phiz::testing {
namespace {

const std::string recording = "../shared/data/performance-livelink/dao.csv";

/// Triangles of the skin with a corner on a lip.
std::vector<Eigen::Index> lip_triangles(const HeadTemplate& head) {
  std::vector<bool> on_lip(static_cast<std::size_t>(head.skin.V.rows()), false);
  for (const std::string region : {"upperLip", "lowerLip"})
    for (const int v : head.skin_regions.at(region)) on_lip[static_cast<std::size_t>(v)] = true;
  std::vector<Eigen::Index> triangles;
  for (Eigen::Index t = 0; t < head.skin.F.rows(); ++t)
    for (int c = 0; c < 3; ++c)
      if (on_lip[static_cast<std::size_t>(head.skin.F(t, c))]) {
        triangles.push_back(t);
        break;
      }
  return triangles;
}

/// Area vector of a triangle.
template <class Positions>
Vector3d area_vector(const Positions& V, const MatrixX3i& F, Eigen::Index t) {
  const Vector3d a = V.row(F(t, 0)).transpose().template cast<double>();
  const Vector3d b = V.row(F(t, 1)).transpose().template cast<double>();
  const Vector3d c = V.row(F(t, 2)).transpose().template cast<double>();
  return 0.5 * (b - a).cross(c - a);
}

/// Area (square metres) of triangles that are folded over against their surroundings: their normal opposes the sum of
/// the area vectors at each of their corners.
template <class Positions>
double inverted(const Positions& V, const MatrixX3i& F, const std::vector<Eigen::Index>& triangles) {
  MatrixX3d around = MatrixX3d::Zero(V.rows(), 3);
  for (Eigen::Index t = 0; t < F.rows(); ++t)
    for (int c = 0; c < 3; ++c) around.row(F(t, c)) += area_vector(V, F, t).transpose();
  double folded = 0;
  for (const Eigen::Index t : triangles) {
    const Vector3d n = area_vector(V, F, t);
    bool opposed = true;
    for (int c = 0; c < 3; ++c) opposed = opposed && n.dot(around.row(F(t, c)).transpose() - n) < 0;
    if (opposed) folded += 0.5 * n.norm();
  }
  return folded;
}

TEST(Recording, StandardHeadPlaysItWithoutPenetrationInversionOrLossOfVolume) {
  if (!std::filesystem::exists(recording))
    GTEST_SKIP() << recording << " is absent: open data is not part of the project";
  const ScratchFolder scratch;
  const std::string path = scratch / "take.phiz";
  const Outcome outcome = phiz_command({"animate", PHIZ_STANDARD_HEAD, recording, "-o", path});
  ASSERT_EQ(outcome.code, 0) << outcome.err;

  const HeadTemplate head = load_head_template(PHIZ_STANDARD_HEAD);
  const std::vector<Eigen::Index> lips = lip_triangles(head);
  EXPECT_EQ(inverted(head.skin.V, head.skin.F, lips), 0);
  const FleshDepth flesh(head, OwnFlesh::surroundings);
  const TakeReader take(path);
  ASSERT_EQ(take.frames(), 180);
  for (int f = 0; f < take.frames(); ++f) {
    const TakeFrame frame = take.frame(f);
    EXPECT_LE(frame.statistics.penetration, 1e-4) << "frame " << f;
    EXPECT_LE(flesh.deepest(frame.volume.cast<double>()), 1e-4) << "frame " << f;
    EXPECT_LE(std::abs(frame.statistics.volume_change), 0.02) << "frame " << f;
    EXPECT_EQ(inverted(frame.skin, head.skin.F, lips), 0) << "frame " << f;
    EXPECT_TRUE(frame.statistics.converged) << "frame " << f;
    EXPECT_TRUE(frame.skin.allFinite()) << "frame " << f;
  }
}

}  // namespace
}  // namespace phiz::testing
