// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/geometry/solidify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "phiz/core/random.h"
#include "phiz/geometry/remesh.h"

namespace phiz {
namespace {

TriangleMesh ball(double radius, const Vector3d& centre) {
  PolygoniseOptions options;
  options.edge_length = 0.08 * radius;
  return polygonise([&](const Vector3d& p) { return (p - centre).norm() - radius; },
                    {centre - Vector3d::Constant(1.4 * radius), centre + Vector3d::Constant(1.4 * radius)}, options);
}

std::ptrdiff_t filled(const VoxelFlags& cells) {
  return std::count(cells.begin(), cells.end(), 1);
}

/// A hollow box of walls one cell thick, outer edge 21 cells, with a square door of `door` cells in one side.
VoxelFlags hollow_box(const VoxelGrid& grid, int door) {
  VoxelFlags cells(static_cast<std::size_t>(grid.count()), 0);
  for (std::ptrdiff_t c = 0; c < grid.count(); ++c) {
    const Eigen::Vector3i d = (grid.cell(c).array() - grid.size.array() / 2).abs();
    const bool in_door = grid.cell(c).x() > grid.size.x() / 2 && d.y() < (door + 1) / 2 && d.z() < (door + 1) / 2;
    cells[static_cast<std::size_t>(c)] = d.maxCoeff() == 10 && !in_door ? 1 : 0;
  }
  return cells;
}

TEST(Solidify, FillsOverlappingPiecesAsTheirUnion) {
  const VoxelGrid grid = grid_round({Vector3d(-1, -1, -1), Vector3d(1.8, 1, 1)}, 0.05, 0.2);
  VoxelFlags cells(static_cast<std::size_t>(grid.count()), 0);
  fill_inside(grid, ball(1, Vector3d::Zero()), cells);
  const double one = static_cast<double>(filled(cells)) * std::pow(0.05, 3);
  EXPECT_NEAR(one, 4.0 / 3 * M_PI, 0.06);
  fill_inside(grid, ball(1, Vector3d(0.8, 0, 0)), cells);
  // Two unit balls at distance d share pi (4 + d) (2 - d)^2 / 12.
  const double both = 8.0 / 3 * M_PI - M_PI * 4.8 * 1.44 / 12;
  EXPECT_NEAR(static_cast<double>(filled(cells)) * std::pow(0.05, 3), both, 0.1);
}

TEST(Solidify, DistancesAreThoseToTheNearestMarkedCell) {
  VoxelGrid grid;
  grid.spacing = 0.5;
  grid.size = {9, 7, 8};
  VoxelFlags marked(static_cast<std::size_t>(grid.count()), 0);
  Random random(3);
  for (int i = 0; i < 6; ++i) marked[random.below(static_cast<std::uint32_t>(marked.size()))] = 1;
  const std::vector<float> distance = distance_to(grid, marked);
  for (std::ptrdiff_t c = 0; c < grid.count(); ++c) {
    double nearest = 1e9;
    for (std::ptrdiff_t m = 0; m < grid.count(); ++m)
      if (marked[static_cast<std::size_t>(m)]) nearest = std::min(nearest, (grid.centre(c) - grid.centre(m)).norm());
    EXPECT_NEAR(distance[static_cast<std::size_t>(c)], nearest, 1e-5);
  }
}

TEST(Solidify, SealsWhatABallCannotEnter) {
  VoxelGrid grid;
  grid.spacing = 1;
  grid.size = {33, 33, 33};
  VoxelFlags narrow = hollow_box(grid, 3), wide = hollow_box(grid, 11);
  const std::ptrdiff_t walls = filled(wide);
  seal_gaps(grid, 3, narrow);
  EXPECT_EQ(filled(narrow), 21 * 21 * 21 - 3 * 3);  // all but the door itself
  seal_gaps(grid, 3, wide);
  EXPECT_LT(filled(wide), walls + 2000);  // only corners
}

TEST(Solidify, FillsCavesThroughWhoseDoorsLittleIsSeen) {
  VoxelGrid grid;
  grid.spacing = 1;
  grid.size = {33, 33, 33};
  VoxelFlags cave = hollow_box(grid, 7), niche = hollow_box(grid, 19);
  const std::ptrdiff_t before = filled(niche);
  fill_caves(grid, 0.87, 2, cave);
  EXPECT_GT(filled(cave), 5000);
  fill_caves(grid, 0.99, 2, niche);
  EXPECT_EQ(filled(niche), before);
}

TEST(Solidify, ASignedDistanceIsNearlyThatOfTheBall) {
  const VoxelGrid grid = grid_round({Vector3d::Constant(-1), Vector3d::Constant(1)}, 0.05, 0.4);
  VoxelFlags cells(static_cast<std::size_t>(grid.count()), 0);
  fill_inside(grid, ball(1, Vector3d::Zero()), cells);
  const VoxelField field = signed_distance_field(grid, cells);
  for (const double r : {0.5, 0.8, 1.0, 1.2, 1.35})
    for (const Vector3d& direction : sphere_directions(20)) EXPECT_NEAR(field(r * direction), r - 1, 0.04);
}

}  // namespace
}  // namespace phiz
