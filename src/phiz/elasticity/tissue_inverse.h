// SPDX-License-Identifier: GPL-3.0-or-later
/// Inverse physics: the activations whose equilibrium has given vertices at given places (Ichim et al. 2017, section
/// 5; phace.md sections 5 and 9).
#pragma once

#include <vector>

#include "phiz/elasticity/contact.h"
#include "phiz/elasticity/muscle_prior.h"
#include "phiz/elasticity/tissue_body.h"

namespace phiz {

/// Where a vertex should be.
struct ShapeTarget {
  int vertex = -1;
  Vector3d place = Vector3d::Zero();   ///< metres
  Vector3d normal = Vector3d::Zero();  ///< unit, of the target's surface; 0: only the distance to the place counts
  double weight = 1;
};

struct InverseOptions {
  /// Of the squared distances to the place and to the plane through it across the normal: the latter forgives
  /// correspondences that slipped along the surface. A target without normal counts with the sum of both.
  double point_weight = 0.1, plane_weight = 1;
  MusclePriorWeights prior;
  int max_iterations = 40;
  double tolerance = 1e-4;  ///< ends when the next step promises to lower the objective by a smaller share, or 1e-6
  /// Equilibria by the reference engine, to its 1e-8, rather than by the real-time one: for small bodies.
  bool exact = false;
};

struct InverseResult {
  std::vector<Matrix3d> stretches;  ///< of every tet of the body, I where there is no muscle
  VectorXd contractions;            ///< per muscle: MusclePrior
  MatrixX3d x;                      ///< the equilibrium under them
  bool converged = false;
  int iterations = 0;
  double start = 0;                ///< root of the weighted mean squared distance to the places at the start, metres
  double distance = 0;             ///< the same at x
  double gradient = 0;             ///< of the objective, relative to that at the start
  std::vector<double> objectives;  ///< at the start and after every iteration, falling
};

/// Minimises  mean of the weighted squared distances / mm^2 + MusclePrior  over the activations of the tets with
/// muscle, with the body in equilibrium throughout, by Gauss and Newton's method on the reduced problem: the force
/// balance is eliminated, f(x, a) = 0, dx = -H^-1 (df/da) da, contractions too (the best ones for any activations,
/// section 5.2), and the normal equations are solved by conjugate gradients. Starts from the stretches of `start`
/// (empty: neutral) and from the state x, which pins and slides hold; contacts that push are held in a step. Throws
/// phiz::Error(bad_input) for malformed targets, muscles and options, and phiz::Error(failure) where there is no
/// equilibrium to start from.
InverseResult find_activations(const TissueBody& body, const std::vector<ShapeTarget>& targets,
                               const std::vector<MuscleFibres>& muscles, const MatrixX3d& x,
                               const std::vector<Matrix3d>& start = {}, const InverseOptions& options = {},
                               ContactScene* contacts = nullptr);

}  // namespace phiz
