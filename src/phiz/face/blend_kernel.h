// SPDX-License-Identifier: GPL-3.0-or-later
/// The inner loop of TargetBlender (Highway, run-time dispatch). Not a public header.
#pragma once

#include <cstddef>

namespace phiz {

/// Blends one block of eight tets. `entries`: for each of `count` shapes 9 x 8 floats (rotation vector, then xx, yy,
/// zz, xy, xz, yz of S - I); `shape`: its number; `weights`: per shape. Writes 9 x 8 doubles of R S (column-major) and
/// 6 x 8 of S.
void blend_block(const float* entries, const int* shape, std::ptrdiff_t count, const float* weights, double* target,
                 double* stretch, double* goal);

}  // namespace phiz
