// SPDX-License-Identifier: GPL-3.0-or-later
/// The local step of projective dynamics, fused: energy and nodal forces of the target, shape and volume terms for
/// blocks of eight tets held as structure of arrays, with Highway and run-time dispatch.
#pragma once

#include <hwy/aligned_allocator.h>

#include <cstddef>
#include <cstdint>

#include "phiz/geometry/mesh.h"

namespace phiz {

/// Weights of the terms, relative to the shear scale.
struct TermWeights {
  double target = 1;
  double shape = 0;
  double volume = 0;
};

/// Tets in blocks of eight; the last block is filled with copies of weight zero. Entry [k] of lane l of block b of an
/// array with K entries per tet lies at (b * K + k) * 8 + l. Matrices are column-major.
struct ElementBlocks {
  static constexpr std::ptrdiff_t width = 8;

  /// `target_share`: factor of the target term per tet; empty for one.
  ElementBlocks(const MatrixX3d& rest, const MatrixX4i& tets, const VectorXd& stiffness, const VectorXd& target_share);

  std::ptrdiff_t tets = 0;
  std::ptrdiff_t blocks = 0;
  hwy::AlignedFreeUniquePtr<double[]> inverse;       ///< inverse of the rest edge matrix, 9
  hwy::AlignedFreeUniquePtr<double[]> weight;        ///< rest volume times stiffness, 1
  hwy::AlignedFreeUniquePtr<double[]> rest_volume;   ///< cubic metres, 1
  hwy::AlignedFreeUniquePtr<double[]> target_share;  ///< factor of the target term, 1
  hwy::AlignedFreeUniquePtr<double[]> target;        ///< target deformation gradient, 9
  hwy::AlignedFreeUniquePtr<double[]> stretch;       ///< symmetric stretch of the shape term: xx, yy, zz, xy, xz, yz
  hwy::AlignedFreeUniquePtr<double[]> goal;          ///< cube root of the determinant that the volume term asks for, 1
  hwy::AlignedFreeUniquePtr<std::int32_t[]> vertex;  ///< vertex of each corner, 4
};

/// Evaluates blocks [begin, end). `x`: four doubles per vertex (x, y, z, unused), 32-byte aligned. `gradient`:
/// derivative of the energy with respect to each corner, four doubles at ((b * 4 + corner) * 8 + lane) * 4. Returns the
/// energy.
double evaluate_elements(const ElementBlocks& elements, const TermWeights& weights, const double* x, double* gradient,
                         std::ptrdiff_t begin, std::ptrdiff_t end);

/// Volume of blocks [begin, end) in the deformed state, counting each tet det F times its rest volume.
double deformed_volume(const ElementBlocks& elements, const double* x, std::ptrdiff_t begin, std::ptrdiff_t end);

}  // namespace phiz
