// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/geometry/voxels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "geometry/shapes.h"
#include "phiz/core/error.h"
#include "phiz/core/random.h"

namespace phiz {
namespace {

std::ptrdiff_t filled(const VoxelFlags& flags) {
  return std::count(flags.begin(), flags.end(), 1);
}

TEST(Voxels, of_a_ball_have_its_volume) {
  const SurfaceVoxels voxels(test::sphere({0.3, 0.1, -0.2}, 1, 4), 0.05, 0.1);
  const double volume = static_cast<double>(filled(voxels.inside())) * std::pow(voxels.grid().spacing, 3);
  EXPECT_NEAR(volume, 4.0 / 3 * std::numbers::pi, 0.04);
}

TEST(Voxels, know_exactly_what_the_surface_contains) {
  const Vector3d centre(0.3, 0.1, -0.2);
  const SurfaceVoxels voxels(test::sphere(centre, 1, 5), 0.1, 0.1);
  Random random(1);
  for (int i = 0; i < 5000; ++i) {
    const Vector3d p =
        centre + 1.3 * (2 * Vector3d(random.uniform(), random.uniform(), random.uniform()).array() - 1).matrix();
    const double r = (p - centre).norm();
    if (std::abs(r - 1) < 0.005) continue;
    EXPECT_EQ(voxels.contains(p), r < 1) << p.transpose();
  }
}

TEST(Voxels, round_trip_between_numbers_cells_and_places) {
  const SurfaceVoxels voxels(test::box({0, 0, 0}, {1, 2, 3}), 0.1, 0.2);
  const VoxelGrid& grid = voxels.grid();
  for (std::ptrdiff_t v = 0; v < grid.count(); v += 97) {
    EXPECT_EQ(grid.holding(grid.centre(v)), v);
    const Eigen::Vector3i c = grid.cell(v);
    EXPECT_EQ(c.x() * grid.stride(0) + c.y() * grid.stride(1) + c.z() * grid.stride(2), v);
  }
  EXPECT_EQ(grid.holding({-5, 0, 0}), -1);
  EXPECT_EQ(grid.holding(Vector3d::Constant(NAN)), -1);
}

TEST(Voxels, closing_joins_what_is_near_and_leaves_what_is_far) {
  TriangleMesh two = test::box({0, 0, 0}, {1, 1, 1}), other = test::box({1.3, 0, 0}, {2.3, 1, 1});
  const Eigen::Index n = two.V.rows();
  two.V.conservativeResize(2 * n, 3);
  two.V.bottomRows(n) = other.V;
  two.F.conservativeResize(24, 3);
  two.F.bottomRows(12) = other.F.array() + static_cast<int>(n);
  const SurfaceVoxels voxels(two, 0.1, 0.6);
  const auto pieces = [&](const VoxelFlags& flags) {
    const std::vector<int> labels = voxel_pieces(voxels.grid(), flags);
    return *std::max_element(labels.begin(), labels.end()) + 1;
  };
  EXPECT_EQ(pieces(voxels.inside()), 2);
  EXPECT_EQ(pieces(close_gaps(voxels.grid(), voxels.inside(), 0.1)), 2);
  const VoxelFlags closed = close_gaps(voxels.grid(), voxels.inside(), 0.35);
  EXPECT_EQ(pieces(closed), 1);
  EXPECT_LE(filled(closed), filled(voxels.inside()) + 10 * 10 * 4);
  for (std::size_t i = 0; i < closed.size(); ++i) EXPECT_GE(closed[i], voxels.inside()[i]);
}

TEST(Voxels, too_many_are_refused) {
  EXPECT_THROW(SurfaceVoxels(test::box({0, 0, 0}, {1, 1, 1}), 1e-4, 0), Error);
  EXPECT_THROW(SurfaceVoxels(TriangleMesh{}, 0.1, 0), Error);
}

}  // namespace
}  // namespace phiz
