// SPDX-License-Identifier: GPL-3.0-or-later
/// The inner loop of TargetBlender (Highway, run-time dispatch). Not a public header.
#pragma once

#include <cstddef>
#include <cstdint>

namespace phiz {

constexpr std::ptrdiff_t blend_width = 16;   ///< tets per block
constexpr std::ptrdiff_t blend_values = 10;  ///< per tet and shape: rotation vector, S - I (xx, yy, zz, xy, xz, yz),
                                             ///< and a third of the logarithm of the volume that is excused

/// Blends one block of tets. `entries`: blend_values x blend_width for each of `count` shapes, in units of the shape;
/// `shape`: its number; `scaled_weights`: weight times unit, blend_values per shape. Writes R S (9 x blend_width,
/// column-major), S (6 x blend_width) and the volume goal.
void blend_block(const std::int16_t* entries, const int* shape, std::ptrdiff_t count, const float* scaled_weights,
                 float* target, float* stretch, float* goal);

}  // namespace phiz
