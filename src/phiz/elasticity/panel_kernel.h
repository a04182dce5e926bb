// SPDX-License-Identifier: GPL-3.0-or-later
/// The dense inner loop of the supernodal solve: a small matrix times four right-hand sides of which three count, in
/// single precision (Highway, run-time dispatch).
#pragma once

#include <cstddef>

namespace phiz {

/// Rows of a panel are held in groups of this many lanes.
constexpr std::ptrdiff_t panel_group = 16;

/// Floats that a panel of that size takes.
constexpr std::ptrdiff_t panel_size(std::ptrdiff_t rows, std::ptrdiff_t columns) {
  return (rows + panel_group / 2 - 1) / (panel_group / 2) * (panel_group / 2) * columns;
}

/// Where entry (row, column) of a panel is: groups of 16 rows one after the other, column by column; if at most 8 rows
/// are left for the last group, it is 8 wide.
constexpr std::ptrdiff_t panel_at(std::ptrdiff_t rows, std::ptrdiff_t columns, std::ptrdiff_t row,
                                  std::ptrdiff_t column) {
  const std::ptrdiff_t first = row / panel_group * panel_group;
  const std::ptrdiff_t width = rows - first <= panel_group / 2 ? panel_group / 2 : panel_group;
  return first * columns + column * width + (row - first);
}

/// y = P x. x: four floats per column; y: four per row, with room for rows rounded up to a multiple of 16; both 64-byte
/// aligned. The fourth of each is not used.
void panel_multiply(const float* P, std::ptrdiff_t rows, std::ptrdiff_t columns, const float* x, float* y);

}  // namespace phiz
