// SPDX-License-Identifier: GPL-3.0-or-later
/// A second way to the same static state, to measure ProjectiveDynamics against: projected Newton on the true energy,
/// the Hessian assembled from the scalar terms and factorised anew in every iteration, contact by an active set. Slow
/// and plain; it shares no solver code with the fast path, only the contact geometry.
#pragma once

#include <vector>

#include "phiz/elasticity/projective_dynamics.h"

namespace phiz {

/// What a tet strives for.
struct TetTarget {
  Matrix3d gradient = Matrix3d::Identity();  ///< of the target term
  Matrix3d stretch = Matrix3d::Identity();   ///< of the shape term
  double volume = 1;                         ///< determinant that the volume term asks for
};

struct NewtonOptions {
  int max_iterations = 60;
  double step_tolerance = 1e-7;  ///< ends when an iteration moves no vertex farther, metres
};

/// Minimises the energy of `body` (statics, without attachments) with one target per tet over its free vertices, from
/// and to x.
SolveStatistics newton_reference(const ElasticBody& body, const std::vector<TetTarget>& targets, MatrixX3d& x,
                                 ContactScene* contacts, const NewtonOptions& options = {});

}  // namespace phiz
