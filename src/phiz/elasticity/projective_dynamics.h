// SPDX-License-Identifier: GPL-3.0-or-later
/// Projective dynamics of a tetrahedral body (Ichim 2017, sections 5.2, 5.3.4 and 5.3.5): a constant factorised
/// quadratic part, a local step over the tets, unilateral contact through the Schur complement of the factor, and
/// quasi-Newton acceleration (Liu, Bouaziz and Kavan 2017). SI units; positions n x 3.
#pragma once

#include <memory>
#include <vector>

#include "phiz/elasticity/contact.h"
#include "phiz/elasticity/element_kernel.h"
#include "phiz/elasticity/solve_statistics.h"
#include "phiz/geometry/mesh.h"

namespace phiz {

/// Holds a vertex to a point with energy weight |x - point|^2, weight in N/m.
struct Attachment {
  int vertex = -1;
  double weight = 0;
  Vector3d point = Vector3d::Zero();
  /// If not zero, a unit normal: only the distance to the plane through `point` counts (E_planeDist).
  Vector3d normal = Vector3d::Zero();
};

/// Of the local step: with single precision it takes half the time, forces are good to a millionth of those of the tets
/// and a state settles to some ten nanometres. Positions are double in either case.
enum class Precision { single, full };

/// What is simulated. Vertices of no tet keep their positions, as the fixed ones do.
struct ElasticBody {
  MatrixX3d rest;                       ///< n x 3, metres
  MatrixX4i tets;                       ///< m x 4
  std::vector<char> fixed;              ///< n: positions prescribed
  VectorXd stiffness;                   ///< shear scale per tet, pascals, > 0
  TermWeights weights;                  ///< of the terms, relative to `stiffness`
  VectorXd target_share;                ///< factor of the target term per tet, >= 0; empty for one everywhere
  std::vector<Attachment> attachments;  ///< vertices and weights stay; points and normals may change later
  VectorXd mass;                        ///< n, kg; empty for statics
  double time_step = 0;                 ///< seconds of backward Euler; 0 for statics
  Precision precision = Precision::full;
};

struct SolveOptions {
  int max_iterations = 60;
  int min_iterations = 1;
  double step_tolerance = 5e-6;         ///< ends when an iteration moves no vertex farther, metres
  double residual_tolerance = 1e-3;     ///< and the relative force residual is below this
  double penetration_tolerance = 5e-5;  ///< and nothing penetrates deeper, metres
  int history = 6;                      ///< pairs of the quasi-Newton method; 0: plain local/global steps
  double longest_step = 4e-3;           ///< no vertex moves farther in one iteration, metres
};

struct ElasticSystem;

class ProjectiveDynamics {
 public:
  /// Orders and factorises. Throws phiz::Error: bad_input for indices out of range, NaN, tets that are not positive;
  /// failure for a body that hangs on nothing. `contact_vertices`: those that may take part in contact rows.
  explicit ProjectiveDynamics(const ElasticBody& body, const VectorXi& contact_vertices = {});
  ~ProjectiveDynamics();
  ProjectiveDynamics(ProjectiveDynamics&&) noexcept;
  ProjectiveDynamics& operator=(ProjectiveDynamics&&) noexcept;

  /// Targets of the tets of a body of single precision, in the kernel's layout; `slot(t)` is the place of tet t.
  ElementBlocks<float>& elements();
  std::ptrdiff_t slot(std::ptrdiff_t tet) const;
  void set_target(std::ptrdiff_t tet, const Matrix3d& F, const Matrix3d& stretch);
  void set_attachment(std::size_t index, const Vector3d& point, const Vector3d& normal = Vector3d::Zero());
  /// Inertial prediction y of every vertex (n x 3), for bodies with a time step: energy 1/(2 h^2) |x - y|_M^2.
  void set_prediction(const MatrixX3d& y);
  /// External force per vertex (n x 3), newtons; an empty matrix for none.
  void set_forces(const MatrixX3d& forces);

  /// Minimises the energy over the free vertices, from and to `x`; rows of fixed vertices are their prescribed
  /// positions. `contacts` may be null. On failure (statistics.converged = false) x is the best state reached, never
  /// NaN. Steps of one solve speed up the next: results depend on earlier solves, within the tolerances, unless
  /// forget() comes between.
  SolveStatistics solve(MatrixX3d& x, const SolveOptions& options, ContactScene* contacts = nullptr);

  /// Drops what earlier solves taught about the curvature.
  void forget();

  /// Energy and its gradient at x (n x 3; rows of fixed vertices hold the reaction).
  double energy(const MatrixX3d& x, MatrixX3d* gradient = nullptr);
  /// Sum over the tets of their volume at x, cubic metres, and at rest.
  double volume(const MatrixX3d& x) const;
  double rest_volume() const;
  std::ptrdiff_t free_vertices() const;
  std::ptrdiff_t factor_entries() const;

 private:
  std::unique_ptr<ElasticSystem> system_;
};

}  // namespace phiz
