// SPDX-License-Identifier: GPL-3.0-or-later
/// Energy, forces and stiffness of muscle and passive tissue (constitutive.h) for blocks of tets held as structure of
/// arrays, in single precision but for positions and their differences, with Highway and run-time dispatch.
#pragma once

#include <hwy/aligned_allocator.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "phiz/elasticity/tissue_body.h"

namespace phiz {

/// Tets in blocks of 16; those with muscle come first. The last block of either kind is filled with copies of no
/// volume. Tet `slot` is lane slot % 16 of block slot / 16. Matrices are column-major. Blocks are in chunks, whose
/// forces are summed apart.
struct TissueBlocks {
  static constexpr std::ptrdiff_t width = 16;
  static constexpr std::ptrdiff_t chunk = 32;  ///< blocks
  using Array = hwy::AlignedFreeUniquePtr<float[]>;

  /// Where entry k of a tet is, in an array with `entries` values per tet.
  static constexpr std::size_t at(std::ptrdiff_t slot, std::ptrdiff_t entries, std::ptrdiff_t k) {
    return static_cast<std::size_t>((slot / width * entries + k) * width + slot % width);
  }

  TissueBlocks() = default;
  /// `row_of`: row of x of each vertex of the body; neighbours should have rows near each other.
  TissueBlocks(const TissueBody& body, const VectorXi& row_of);

  std::ptrdiff_t tets = 0;
  std::ptrdiff_t muscle_blocks = 0, blocks = 0;
  PassiveLaw passive = PassiveLaw::corotated;
  VectorXi slot_of;                                  ///< of each tet
  Array inverse;                                     ///< inverse of the grown rest edge matrix, 9
  Array volume;                                      ///< rest volume, 1
  Array mu, lambda;                                  ///< pascals, 1 each
  Array active;                                      ///< share of muscle, 1
  Array stretch;                                     ///< what muscle strives for: xx, yy, zz, xy, xz, yz
  hwy::AlignedFreeUniquePtr<std::int32_t[]> vertex;  ///< four rows of x per slot, one after the other
  std::vector<int> chunk_rows;                       ///< rows of x that each chunk touches, chunk after chunk
  std::vector<int> chunk_start;                      ///< into chunk_rows, per chunk and the end
  std::vector<std::uint16_t> local;                  ///< like `vertex`, into the rows of the chunk

  std::ptrdiff_t chunks() const { return static_cast<std::ptrdiff_t>(chunk_start.size()) - 1; }
  void set_stretch(std::ptrdiff_t tet, const Matrix3d& S);
};

/// Evaluates a chunk. `x`: four doubles per row. `sums`: four floats per row of the chunk: the derivative of the energy
/// and the sum of the norms of what its tets contribute. Returns the energy, joules.
double evaluate_tissue(const TissueBlocks& blocks, const double* x, std::ptrdiff_t chunk, float* sums);

/// Pairs of corners of a tet, in the order of their blocks in a stiffness.
constexpr int corner_pairs[10][2] = {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {1, 0}, {2, 0}, {3, 0}, {2, 1}, {3, 1}, {3, 2}};

/// For tissue_stiffness(): no bound, the exact Hessian.
constexpr double any_curvature = -1e300;

/// The Hessian of blocks [begin, end) for the given stretches (as TissueBlocks::stretch): per slot ten 3x3 blocks one
/// after the other, column-major: entry (i, k) of pair (a, b) is the second derivative by coordinate i of corner a and
/// k of corner b. Twists and pressures whose curvature is below `least_curvature` times 2 mu are made weaker until it
/// is not; with 0 the Hessian of a relaxed tet has no negative eigenvalue.
void tissue_stiffness(const TissueBlocks& blocks, const float* stretches, const double* x, double least_curvature,
                      float* stiffness, std::ptrdiff_t begin, std::ptrdiff_t end);

}  // namespace phiz
