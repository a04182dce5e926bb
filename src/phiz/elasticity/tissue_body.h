// SPDX-License-Identifier: GPL-3.0-or-later
/// Bodies of muscle and passive tissue (Ichim et al. 2017, section 4; phace.md sections 4 and 7.2): their energy over
/// the positions of the vertices, and how pins and slides restrict these. SI units; positions n x 3.
#pragma once

#include <vector>

#include "phiz/elasticity/constitutive.h"
#include "phiz/geometry/operators.h"

namespace phiz {

enum class PassiveLaw { corotated, neo_hookean };

/// Holds a vertex to the plane through `point` with unit normal; a vertex may have several.
struct Slide {
  int vertex = -1;
  Vector3d point = Vector3d::Zero();
  Vector3d normal = Vector3d::UnitZ();
};

struct TissueBody {
  MatrixX3d rest;                       ///< n x 3, metres
  MatrixX4i tets;                       ///< m x 4
  std::vector<Moduli> moduli;           ///< m
  VectorXd active;                      ///< m: share of muscle in the tet's volume, 0 to 1; empty for none
  VectorXd growth;                      ///< m: plastic stretch s in every direction, > 0 (1: none); empty for none
  VectorXd density;                     ///< m, kg/m^3; empty for no weight
  Vector3d gravity = Vector3d::Zero();  ///< m/s^2
  PassiveLaw passive = PassiveLaw::corotated;
  std::vector<char> pinned;  ///< n: position prescribed
  std::vector<Slide> slides;
};

/// Throws phiz::Error(bad_input) naming what is malformed: sizes, indices, values out of range or not finite, tets that
/// are not positive.
void validate(const TissueBody& body);

/// Which way the vertices may move: freely, in a plane, along a line, or not at all. The unknowns are coordinates in
/// these spaces.
class FreeMotion {
 public:
  explicit FreeMotion(const TissueBody& body);

  Eigen::Index size() const { return size_; }
  /// First unknown of a vertex, and the directions (3 x k, orthonormal) of its k unknowns.
  int first(Eigen::Index vertex) const { return first_[vertex]; }
  const Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3>& directions(Eigen::Index vertex) const {
    return directions_[static_cast<std::size_t>(vertex)];
  }
  /// The part of a force (n x 3) that moves something.
  VectorXd reduced(const MatrixX3d& force) const;
  /// Displacement of all vertices by the unknowns.
  MatrixX3d expanded(const VectorXd& unknowns) const;

 private:
  Eigen::Index size_ = 0;
  VectorXi first_;
  std::vector<Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3>> directions_;
};

class TissueEnergy {
 public:
  /// Throws as validate() does.
  explicit TissueEnergy(const TissueBody& body);

  const TissueBody& body() const { return body_; }
  /// The stretch that the muscle in each tet strives for (m; I: relaxed).
  void set_activation(const std::vector<Matrix3d>& stretches);

  /// E_pass + E_act + E_grav (eq. 6.3), joules; the same bits for any thread count.
  double value(const MatrixX3d& x) const;
  /// Its gradient, n x 3; at pinned vertices it is the reaction. `magnitude`, if not null, gets per vertex the sum of
  /// the norms of what the tets contribute: the scale that a residual is relative to.
  MatrixX3d gradient(const MatrixX3d& x, VectorXd* magnitude = nullptr) const;
  /// Its Hessian in the unknowns of `motion`; the pattern does not depend on x.
  SparseMatrixd hessian(const MatrixX3d& x, const FreeMotion& motion, Stiffness kind) const;
  /// Kilograms per vertex, lumped.
  const VectorXd& mass() const { return mass_; }

 private:
  /// Energy, stress and stiffness of all that a tet is made of, per rest volume, at the elastic part of its gradient.
  double tet_energy(Eigen::Index tet, const Matrix3d& F) const;
  Matrix3d tet_stress(Eigen::Index tet, const Matrix3d& F) const;
  Matrix9d tet_stiffness(Eigen::Index tet, const Matrix3d& F, Stiffness kind) const;
  double active(Eigen::Index tet) const { return body_.active.size() > 0 ? body_.active[tet] : 0; }
  Matrix3d elastic_gradient(const MatrixX3d& x, Eigen::Index tet) const {
    return deformation_gradient(x, body_.tets, rest_, tet);
  }

  TissueBody body_;
  TetRest rest_;  ///< of the grown tets; volumes before growth
  std::vector<Matrix3d> stretches_;
  VectorXd mass_;
};

}  // namespace phiz
