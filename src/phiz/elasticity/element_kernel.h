// SPDX-License-Identifier: GPL-3.0-or-later
/// The local step of projective dynamics, fused: energy and nodal forces of the target, shape and volume terms for
/// blocks of tets held as structure of arrays, with Highway and run-time dispatch. In double or in single precision;
/// positions and differences of positions are double in both.
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

/// Tets in blocks of `width`; the last block is filled with copies of weight zero. Tet `slot` is lane slot % width of
/// block slot / width. Matrices are column-major. T: double or float.
template <class T>
struct ElementBlocks {
  static constexpr std::ptrdiff_t width = 64 / sizeof(T);
  using Array = hwy::AlignedFreeUniquePtr<T[]>;

  /// Where entry k of a tet is, in an array with `entries` values per tet.
  static constexpr std::size_t at(std::ptrdiff_t slot, std::ptrdiff_t entries, std::ptrdiff_t k) {
    return static_cast<std::size_t>((slot / width * entries + k) * width + slot % width);
  }

  ElementBlocks() = default;
  /// `target_share`: factor of the target term per tet; empty for one.
  ElementBlocks(const MatrixX3d& rest, const MatrixX4i& tets, const VectorXd& stiffness, const VectorXd& target_share);

  std::ptrdiff_t tets = 0;
  std::ptrdiff_t blocks = 0;
  Array inverse;                                     ///< inverse of the rest edge matrix, 9
  Array weight;                                      ///< rest volume times stiffness, 1
  Array target_share;                                ///< factor of the target term, 1
  Array target;                                      ///< target deformation gradient, 9
  Array stretch;                                     ///< symmetric stretch of the shape term: xx, yy, zz, xy, xz, yz
  Array goal;                                        ///< cube root of the determinant that the volume term asks for, 1
  hwy::AlignedFreeUniquePtr<std::int32_t[]> vertex;  ///< four corners per slot, one after the other
};

/// Evaluates blocks [begin, end). `x`: four doubles per vertex (x, y, z, unused). `gradient`: derivative of the energy
/// with respect to corner c of a slot, four values from 4 * ElementBlocks<T>::at(slot, 4, c) on. Returns the energy.
double evaluate_elements(const ElementBlocks<double>& elements, const TermWeights& weights, const double* x,
                         double* gradient, std::ptrdiff_t begin, std::ptrdiff_t end);
double evaluate_elements(const ElementBlocks<float>& elements, const TermWeights& weights, const double* x,
                         float* gradient, std::ptrdiff_t begin, std::ptrdiff_t end);

/// Sum of the signed volumes of slots [begin, end), cubic metres.
template <class T>
double deformed_volume(const ElementBlocks<T>& elements, const double* x, std::ptrdiff_t begin, std::ptrdiff_t end);

}  // namespace phiz
