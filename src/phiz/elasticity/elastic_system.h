// SPDX-License-Identifier: GPL-3.0-or-later
/// The inside of ProjectiveDynamics: a body in the solver's own numbering (free vertices first, in order of
/// elimination) with four doubles per vertex. Not a public header.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "phiz/elasticity/element_kernel.h"
#include "phiz/elasticity/low_rank_inverse.h"
#include "phiz/elasticity/projective_dynamics.h"
#include "phiz/elasticity/vertex_solver.h"

namespace phiz {

/// The tets of a system with what the kernel writes.
template <class T>
struct ElementForces {
  ElementBlocks<T> blocks;
  hwy::AlignedFreeUniquePtr<T[]> corners;  ///< four values per corner of a slot
};

using AlignedVector = hwy::AlignedFreeUniquePtr<double[]>;

struct ElasticSystem {
  ElasticSystem(const ElasticBody& body, const VectorXi& contact_vertices);

  std::ptrdiff_t vertices = 0;  ///< all
  std::ptrdiff_t free = 0;      ///< the first rows
  std::ptrdiff_t size() const { return 4 * free; }
  VectorXi row_of;                      ///< solver row of each body vertex
  std::vector<std::ptrdiff_t> slot_of;  ///< kernel slot of each tet
  std::variant<ElementForces<float>, ElementForces<double>> elements;
  TermWeights weights;
  std::vector<Attachment> attachments;   ///< with solver rows
  VectorXd inertia;                      ///< mass / h^2 per solver row, or empty
  AlignedVector prediction, force;       ///< four per row
  std::optional<LowRankInverse> memory;  ///< what earlier steps taught about the curvature
  bool has_force = false;
  std::unique_ptr<VertexSolver> solver;
  VectorXi compliance_row;  ///< row of `compliance` per solver row, or -1
  MatrixXd compliance;      ///< rows and columns of A^-1 that belong to contact vertices

  std::vector<int> incidence_start, incidence;  ///< corners that add up at each row
  std::span<const int> corners_of(std::ptrdiff_t row) const {
    const auto r = static_cast<std::size_t>(row);
    return {incidence.data() + incidence_start[r], incidence.data() + incidence_start[r + 1]};
  }
  double rest_volume = 0;
  double smallest_force = 0;   ///< root of the sum of squares of what moves each vertex alone by a micrometre, newtons
  double smallest_energy = 0;  ///< of moving each vertex alone by a nanometre, joules
  double energy_rounding = 0;  ///< relative error of evaluate()

  void set_target(std::ptrdiff_t tet, const Matrix3d& F, const Matrix3d& stretch);
  void load(const MatrixX3d& positions, double* x) const;
  void store(const double* x, MatrixX3d& positions) const;
  /// Energy; gradient at the first `rows` rows (4 x rows). Out: float or double.
  template <class Out>
  double evaluate(const double* x, Out* gradient, std::ptrdiff_t rows);
  double add_inertia_and_forces(const double* x, std::ptrdiff_t row, Eigen::Vector4d& gradient) const;
  /// Sum of the volumes of the tets, cubic metres.
  double volume(const double* x) const;
  /// What a force residual is measured against, after evaluate(): root of the sum over free rows of (sum of the norms
  /// of the forces of its tets)^2, at least smallest_force.
  double force_scale() const;
};

}  // namespace phiz
