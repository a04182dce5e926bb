// SPDX-License-Identifier: GPL-3.0-or-later
/// Laws of soft tissue as energy, stress and stiffness of one tet: densities per rest volume as functions of its
/// deformation gradient F (Ichim et al. 2017, eq. 1 and 2; phace.md sections 4 and 9). A 3x3 matrix is read as a
/// 9-vector column by column. All of them hold for every finite F, singular and inverted ones too.
#pragma once

#include "phiz/elasticity/terms.h"

namespace phiz {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix9x6d = Eigen::Matrix<double, 9, 6>;

/// Shear and volume stiffness, pascals. In terms of small strains mu and 2 lambda are Lame's constants, for every law.
struct Moduli {
  double mu = 3000;
  double lambda = 9000;
};

/// The symmetric stretch that a muscle strives for, from its six activations: [a0 a3 a4; a3 a1 a5; a4 a5 a2].
Matrix3d activation_stretch(const Vector6d& a);
/// Its inverse, for symmetric S.
Vector6d activation_of(const Matrix3d& S);
/// The activation of stretch I.
Vector6d neutral_activation();
/// One degree of freedom, the paper's baseline: length `contraction` along the unit vector `fibre`, 1 across.
Matrix3d fibre_stretch(const Vector3d& fibre, double contraction);

/// Whether a stiffness is the derivative of the stress, or a positive semidefinite matrix near it: each term's own
/// negative part is removed, by closed forms.
enum class Stiffness { exact, projected };

/// Muscle with 6-DoF activation (eq. 2): mu min_R |F - R S|^2 + lambda (det F - det S)^2. Passive tissue with S = I
/// (eq. 1). Invariant under rotation: it moves and turns nothing by itself.
double corotated_energy(const Matrix3d& F, const Matrix3d& S, const Moduli& m);
Matrix3d corotated_stress(const Matrix3d& F, const Matrix3d& S, const Moduli& m);
Matrix9d corotated_stiffness(const Matrix3d& F, const Matrix3d& S, const Moduli& m, Stiffness kind);
/// Derivative of the stress by the six activations.
Matrix9x6d corotated_stress_by_activation(const Matrix3d& F, const Matrix3d& S, const Moduli& m);

/// Passive tissue, stable Neo-Hookean (Smith, de Goes and Kim 2018): no state of a tet, inverted or collapsed, is a
/// second minimum. At small strains the same as co-rotated tissue. The energy is 0 at rest.
double neo_hookean_energy(const Matrix3d& F, const Moduli& m);
Matrix3d neo_hookean_stress(const Matrix3d& F, const Moduli& m);
Matrix9d neo_hookean_stiffness(const Matrix3d& F, const Moduli& m, Stiffness kind);

}  // namespace phiz
