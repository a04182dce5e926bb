// SPDX-License-Identifier: GPL-3.0-or-later
/// Energy terms of tets and vertices, those of projective dynamics, each as energy, gradient and Hessian of one element
/// of unit weight (Ichim 2017, eq. 5.1: E = |G x - P(G x)|^2). The terms of a tet are functions of its deformation
/// gradient F; a 3x3 matrix is read as a 9-vector column by column in the Hessians. Multiply by rest volume and
/// stiffness to get joules. The constant quadratic part of every term, which projective dynamics factorises, is 2 G^T
/// G.
#pragma once

#include "phiz/geometry/mesh.h"

namespace phiz {

using Matrix9d = Eigen::Matrix<double, 9, 9>;

/// Shape term: squared distance of F from the rotations of a symmetric stretch S, min_R |F - R S|^2. With S = I it is
/// as-rigid-as-possible elasticity (E_ARAP); with the stretch of a target it is elasticity about that target.
double shape_energy(const Matrix3d& F, const Matrix3d& S);
Matrix3d shape_gradient(const Matrix3d& F, const Matrix3d& S);
Matrix9d shape_hessian(const Matrix3d& F, const Matrix3d& S);
/// The Hessian without its negative part.
Matrix9d shape_projected_hessian(const Matrix3d& F, const Matrix3d& S);
/// Change of the gradient when S changes by the symmetric dS.
Matrix3d shape_gradient_by_stretch(const Matrix3d& F, const Matrix3d& S, const Matrix3d& dS);

/// Volume term: squared distance of F from the matrices of determinant 1 (E_volume).
double volume_energy(const Matrix3d& F);
Matrix3d volume_gradient(const Matrix3d& F);
Matrix9d volume_hessian(const Matrix3d& F);

/// Gradient target: |F - target|^2 (E_target, E_defTransfer; eq. 5.5 and 5.9). Invariant under translation only.
double target_energy(const Matrix3d& F, const Matrix3d& target);
Matrix3d target_gradient(const Matrix3d& F, const Matrix3d& target);

/// Attachment: |x - point|^2 (E_attach).
double attachment_energy(const Vector3d& x, const Vector3d& point);
Vector3d attachment_gradient(const Vector3d& x, const Vector3d& point);

/// Point to plane: (n . (x - point))^2, n of unit length (E_planeDist).
double plane_energy(const Vector3d& x, const Vector3d& point, const Vector3d& normal);
Vector3d plane_gradient(const Vector3d& x, const Vector3d& point, const Vector3d& normal);

}  // namespace phiz
