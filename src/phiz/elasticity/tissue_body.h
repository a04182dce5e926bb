// SPDX-License-Identifier: GPL-3.0-or-later
/// Bodies of muscle and passive tissue (Ichim et al. 2017, section 4; phace.md sections 4 and 7.2): their energy over
/// the positions of the vertices, and how pins and slides restrict these. SI units; positions n x 3.
#pragma once

#include <vector>

#include "phiz/elasticity/constitutive.h"
#include "phiz/geometry/operators.h"

namespace phiz {

enum class PassiveLaw { corotated, neo_hookean };

/// Holds a vertex to a surface near `point`: n . d - d . B d / 2 = 0 with d = x - point. A plane with unit normal n, or
/// a paraboloid that touches it, so that the tangent plane turns as the vertex slides. A vertex may have several.
struct Slide {
  int vertex = -1;
  Vector3d point = Vector3d::Zero();
  Vector3d normal = Vector3d::UnitZ();
  Matrix3d bend = Matrix3d::Zero();  ///< B, symmetric, B n = 0, 1/metre: curvature, positive towards n

  /// How far x is above the surface (to first order), metres, and the gradient of that.
  double height(const Vector3d& x) const { return normal.dot(x - point) - 0.5 * (x - point).dot(bend * (x - point)); }
  Vector3d gradient(const Vector3d& x) const { return normal - bend * (x - point); }
};

struct TissueBody {
  MatrixX3d rest;                       ///< n x 3, metres
  MatrixX4i tets;                       ///< m x 4
  std::vector<Moduli> moduli;           ///< m
  VectorXd active;                      ///< m: share of muscle in the tet's volume, 0 to 1; empty for none
  VectorXd growth;                      ///< m: plastic stretch s in every direction, > 0 (1: none); empty for none
  VectorXd density;                     ///< m, kg/m^3; empty for no weight
  VectorXd added_mass;                  ///< n, kg that vertices carry beside; empty for none
  Vector3d gravity = Vector3d::Zero();  ///< m/s^2
  PassiveLaw passive = PassiveLaw::corotated;
  std::vector<char> pinned;  ///< n: position prescribed
  std::vector<Slide> slides;
};

/// Throws phiz::Error(bad_input) naming what is malformed: sizes, indices, values out of range or not finite, tets that
/// are not positive.
void validate(const TissueBody& body);

/// Puts the sliding vertices that are not pinned on their surfaces.
void put_on_slides(const TissueBody& body, MatrixX3d& x);

/// Which way the vertices may move from x: freely, in a tangent plane, along a line, or not at all. The unknowns are
/// coordinates in these spaces.
class FreeMotion {
 public:
  FreeMotion(const TissueBody& body, const MatrixX3d& x);

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
  /// Other places of the slides, in the order of the body's.
  void set_slides(const std::vector<Slide>& slides);
  /// A force on every vertex that does not depend on x, newtons, n x 3; an empty matrix for none.
  void set_forces(const MatrixX3d& forces);
  /// A step of backward Euler (phace.md section 7.1): adds sum of mass |x - prediction|^2 / (2 h^2), prediction = x + h
  /// v of the step before. An empty prediction: statics.
  void set_inertia(double time_step, const MatrixX3d& prediction);

  /// E_pass + E_act + E_grav (eq. 6.3), the work of the forces and inertia, joules; the same bits for any thread count.
  double value(const MatrixX3d& x) const;
  /// Its gradient, n x 3; at pinned vertices it is the reaction. `magnitude`, if not null, gets per vertex the sum of
  /// the norms of what the tets contribute: the scale that a residual is relative to.
  MatrixX3d gradient(const MatrixX3d& x, VectorXd* magnitude = nullptr) const;
  /// Its Hessian in the unknowns of `motion`, the exact one with what the curvature of the slides adds to it under
  /// their reactions; the pattern does not depend on x.
  SparseMatrixd hessian(const MatrixX3d& x, const FreeMotion& motion, Stiffness kind) const;
  /// Derivative of gradient(x) when all vertices, pinned ones too, move by d (n x 3).
  MatrixX3d gradient_change(const MatrixX3d& x, const MatrixX3d& d) const;
  /// Derivative of motion.reduced(gradient(x)) by the six activations of each of these tets, one tet after the other.
  SparseMatrixd gradient_by_activation(const MatrixX3d& x, const FreeMotion& motion, const VectorXi& tets) const;
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
  MatrixX3d forces_;      ///< or empty
  MatrixX3d prediction_;  ///< or empty
  double time_step_ = 0;
};

}  // namespace phiz
