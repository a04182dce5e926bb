// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "phiz/elasticity/obstacle.h"

namespace phiz {
namespace {

/// A sheet over the profile of `columns` (x, z) per row y: two triangles for each quad, outward is up.
TriangleMesh sheet(const std::vector<double>& rows, const std::vector<std::vector<Eigen::Vector2d>>& profile) {
  const auto across = static_cast<int>(profile.front().size());
  TriangleMesh mesh;
  mesh.V.resize(static_cast<Eigen::Index>(rows.size()) * across, 3);
  mesh.F.resize(2 * (static_cast<Eigen::Index>(rows.size()) - 1) * (across - 1), 3);
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (int c = 0; c < across; ++c) {
      const Eigen::Vector2d& p = profile[r][static_cast<std::size_t>(c)];
      mesh.V.row(static_cast<Eigen::Index>(r) * across + c) << p.x(), rows[r], p.y();
    }
  Eigen::Index f = 0;
  for (int r = 0; r + 1 < static_cast<int>(rows.size()); ++r)
    for (int c = 0; c + 1 < across; ++c) {
      const int a = r * across + c;
      mesh.F.row(f++) << a, a + 1, a + 1 + across;
      mesh.F.row(f++) << a, a + 1 + across, a + across;
    }
  return mesh;
}

TEST(Obstacle, AboveACreaseThatIsPressedPastFlatIsOutside) {
  // A ridge whose flanks have crossed in the middle, where `half` is negative.
  std::vector<std::vector<Eigen::Vector2d>> profile;
  for (const double half : {0.3, -0.01, -0.01, 0.3})
    profile.push_back({{-1, 0}, {-half, 0}, {0, 1}, {half, 0}, {1, 0}});
  const Obstacle ridge = Obstacle::rigid(sheet({-1, -0.2, 0.2, 1}, profile));
  for (const double y : {-0.1, 0.0, 0.1}) {
    const auto contact = ridge.closest({0, y, 1.2}, 1);
    ASSERT_TRUE(contact.has_value());
    EXPECT_NEAR(contact->gap, 0.2, 1e-12) << y;
    EXPECT_NEAR(contact->normal.z(), 1, 1e-12) << y;
  }
}

TEST(Obstacle, AHollowHasTwoWallsAndAHillHasOne) {
  const auto valley = Obstacle::rigid(sheet({-1, 1}, {{{-1, 1}, {0, 0}, {1, 1}}, {{-1, 1}, {0, 0}, {1, 1}}}));
  const Vector3d above(0.05, 0.1, 0.2);
  const auto floor = valley.closest(above, 1);
  ASSERT_TRUE(floor.has_value());
  const auto second = valley.beside(above, *floor, 1);
  ASSERT_EQ(second.size(), 1u);
  EXPECT_NEAR(second.front().gap, (0.05 + 0.2) * std::sqrt(0.5), 1e-12);

  const auto hill = Obstacle::rigid(sheet({-1, 1}, {{{-1, -1}, {0, 0}, {1, -1}}, {{-1, -1}, {0, 0}, {1, -1}}}));
  const Vector3d over(0.05, 0.1, 0.02);
  EXPECT_TRUE(hill.beside(over, *hill.closest(over, 1), 1).empty());
}

TEST(Obstacle, AFaceIsNoWallForAPointBehindItsPlane) {
  // A floor and a wall on it that ends at y = 0; the point has gone round that end.
  TriangleMesh mesh;
  mesh.V.resize(6, 3);
  mesh.V << -5, -5, 0, 5, -5, 0, 0, 5, 0, 0, 0, 0, 0, 0, 1, 0, 1, 0;
  mesh.F.resize(2, 3);
  mesh.F << 0, 1, 2, 3, 4, 5;
  const auto floor_and_wall = Obstacle::rigid(mesh);
  for (const double side : {-1.0, 1.0}) {
    const Vector3d p(0.02 * side, -0.01, 0.03);
    const auto closest = floor_and_wall.closest(p, 1);
    ASSERT_TRUE(closest.has_value());
    EXPECT_EQ(floor_and_wall.beside(p, *closest, 0.1).size(), side < 0 ? 1u : 0u);
  }
}

}  // namespace
}  // namespace phiz
