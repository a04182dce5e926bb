// SPDX-License-Identifier: GPL-3.0-or-later
/// The inside of TissueSolver: a body in the solver's own numbering (vertices that move first, in order of elimination,
/// then pinned ones and those that belong to no tet) with four doubles per row. Not a public header.
#pragma once

#include <functional>
#include <vector>

#include "phiz/elasticity/tissue_kernel.h"
#include "phiz/numerics/block_cholesky.h"

namespace phiz {

using AlignedDoubles = hwy::AlignedFreeUniquePtr<double[]>;
AlignedDoubles zero_doubles(std::ptrdiff_t size);

/// A vertex that slides: the directions that its surfaces leave it.
struct SlidingRow {
  int row = -1;
  std::vector<int> slides;  ///< into TissueBody::slides
  Matrix3d keep = Matrix3d::Identity();
};

/// What a stiffness is taken at; a copy, so that it can be assembled while the solve goes on.
struct StiffnessState {
  std::vector<double> x;       ///< four per row
  std::vector<float> stretch;  ///< as TissueBlocks::stretch
  std::vector<SlidingRow> sliding;
  std::vector<Matrix3d> slide_bend;  ///< per sliding row: curvature times reaction
  double inverse_time_step2 = 0;     ///< 1 / h^2, 0 in statics
};

struct TissueSystem {
  explicit TissueSystem(const TissueBody& body);

  TissueBody body;
  std::ptrdiff_t rows = 0;  ///< all vertices
  std::ptrdiff_t free = 0;  ///< the first rows, which move
  VectorXi row_of;          ///< per vertex of the body
  VectorXi vertex_of;       ///< per row
  TissueBlocks blocks;
  BlockMatrix pattern;  ///< of the stiffness, without values that mean something
  std::vector<SlidingRow> sliding;
  std::vector<int> sliding_of;  ///< per free row: into `sliding`, or -1
  VectorXd mass;                ///< per row, kg
  AlignedDoubles force;         ///< external ones with gravity, four per row
  AlignedDoubles prediction;    ///< of inertia
  double inverse_time_step2 = 0;
  double rest_volume = 0;
  double least_scale2 = 0;  ///< what a force residual is measured against, at least: static_residual.h

  void load(const MatrixX3d& positions, double* x) const;
  void store(const double* x, MatrixX3d& positions) const;
  void set_forces(const MatrixX3d& forces);

  /// Energy, joules, and its gradient at the free rows, four per row; not restricted by slides. `scale2`, if not null:
  /// sum over the free rows of the squared sum of the norms of the tets' forces, at least least_scale2.
  double evaluate(const double* x, double* gradient, double* scale2 = nullptr);
  /// The same where only these chunks of tets changed since the last evaluation.
  double evaluate_again(const std::vector<int>& chunks, const double* x, double* gradient);
  /// Chunks with muscle; those with a row for which `is` says so.
  std::vector<int> muscle_chunks() const;
  std::vector<int> chunks_with(const std::function<bool(int row)>& is) const;
  /// Puts sliding rows on their surfaces and finds the directions that they have there.
  void put_on_slides(double* x);
  /// Removes what slides do not let through.
  void restrict_to_slides(double* gradient) const;
  double volume(const double* x) const;

  StiffnessState stiffness_state(const double* x, const double* gradient) const;
  /// The Hessian at a state, restricted to what slides allow; exact or bounded as tissue_stiffness(). `room`: 90 floats
  /// per slot.
  void assemble(const StiffnessState& state, double least_curvature, bool parallel, std::vector<float>& room,
                BlockMatrix& A) const;

 private:
  void evaluate_chunk(std::ptrdiff_t chunk, const double* x);
  double add_up(const double* x, double* gradient, double* scale2);

  hwy::AlignedFreeUniquePtr<float[]> sums_;       ///< of the chunks
  std::vector<double> energies_;                  ///< of the chunks, joules
  std::vector<int> incidence_start_, incidence_;  ///< entries of sums_ that add up at each row
  std::vector<int> source_start_, source_;        ///< per block of the pattern: 2 (10 slot + pair) + transposed
};

}  // namespace phiz
