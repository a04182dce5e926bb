// SPDX-License-Identifier: GPL-3.0-or-later
/// Internal: fixed sample patterns, the fine bump of skin and the streaks of muscle. Included by sources only.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace phiz::detail {

struct Sample2 {
  float x = 0, y = 0;  // in [0, 1)
};

/// Point `j` of `count` of one of 256 patterns over the square. The points of patterns 16 b to 16 b + 15 together are
/// 16 * count points of the plastic-number lattice (Roberts 2018), for any block b.
Sample2 plane_sample(int j, int count, int pattern);
/// Likewise on the line, golden-ratio sequence.
float line_sample(int j, int count, int pattern);
/// The pattern of a pixel, repeating every 16 pixels; its value modulo 16 takes each value once in any 4 x 4 block.
int pixel_pattern(int x, int y);

/// Offsets in pixels of the lens samples of every pixel: a tent of radius 1 about the pixel's centre, mean zero.
std::vector<Sample2> lens_offsets(int count);

/// Slope of a fine bump at a rest position; fades out when a pixel (`footprint`) is coarser than the bump.
Eigen::Vector3f grain_slope(const Eigen::Vector3f& rest, float strength, float size, float footprint);

/// Streaks along a direction: how much lighter (above 0) or darker than its surroundings a rest position is, about -1
/// to 1, and the slope of the ridges that go with it. `fibre`: unit. Fades out like the grain.
struct Streak {
  float light = 0;
  Eigen::Vector3f slope = Eigen::Vector3f::Zero();
};
Streak fibre_streak(const Eigen::Vector3f& rest, const Eigen::Vector3f& fibre, float size, float footprint);

}  // namespace phiz::detail
