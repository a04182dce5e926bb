// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/constitutive.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "phiz/numerics/svd3.h"

namespace phiz {

namespace {

using Vector9d = Eigen::Matrix<double, 9, 1>;

Vector9d vec(const Matrix3d& A) {
  return Eigen::Map<const Vector9d>(A.data());
}

/// Gradient of the determinant.
Matrix3d cofactor(const Matrix3d& F) {
  Matrix3d C;
  C << F.col(1).cross(F.col(2)), F.col(2).cross(F.col(0)), F.col(0).cross(F.col(1));
  return C;
}

Matrix3d cross_matrix(const Vector3d& a) {
  Matrix3d m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

/// Derivative of the cofactor: the Hessian of the determinant.
Matrix9d determinant_hessian(const Matrix3d& F) {
  Matrix9d H = Matrix9d::Zero();
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;  // column k of the cofactor is f_i x f_j
    H.block<3, 3>(3 * k, 3 * i) = -cross_matrix(F.col(j));
    H.block<3, 3>(3 * k, 3 * j) = cross_matrix(F.col(i));
  }
  return H;
}

/// An isotropic law's stiffness in the frame of the singular vectors of F: `scaling` couples the three stretches, a
/// flip and a twist mode belong to each pair of them.
struct Modes {
  Matrix3d scaling;
  Vector3d flip, twist;  // of the pair that leaves out k
};

Matrix9d positive_part(const Svd3& svd, const Modes& modes) {
  const auto outer = [&svd](int i, int j) { return vec(svd.U.col(i) * svd.V.col(j).transpose()); };
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(modes.scaling);
  Matrix9d H = Matrix9d::Zero();
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const Vector9d flip = outer(i, j) + outer(j, i), twist = outer(i, j) - outer(j, i);
    H += 0.5 * std::max(modes.flip[k], 0.0) * flip * flip.transpose();
    H += 0.5 * std::max(modes.twist[k], 0.0) * twist * twist.transpose();
    const Vector3d w = eigen.eigenvectors().col(k);
    const Vector9d scale = w[0] * outer(0, 0) + w[1] * outer(1, 1) + w[2] * outer(2, 2);
    H += std::max(eigen.eigenvalues()[k], 0.0) * scale * scale.transpose();
  }
  return H;
}

/// Of det F: flips change it by -s_k, twists by s_k to second order.
Modes determinant_modes(const Vector3d& s) {
  Modes modes;
  modes.scaling << 0, s[2], s[1], s[2], 0, s[0], s[1], s[0], 0;
  modes.flip = -s;
  modes.twist = s;
  return modes;
}

/// (det F - target)^2.
Matrix9d volume_stiffness(const Matrix3d& F, double target, Stiffness kind) {
  const double excess = F.determinant() - target;
  if (kind == Stiffness::exact) {
    const Vector9d c = vec(cofactor(F));
    return 2 * c * c.transpose() + 2 * excess * determinant_hessian(F);
  }
  const Svd3 svd = svd3(F);
  const Vector3d c(svd.s[1] * svd.s[2], svd.s[2] * svd.s[0], svd.s[0] * svd.s[1]);
  Modes modes = determinant_modes(svd.s);
  modes.scaling = 2 * (c * c.transpose() + excess * modes.scaling);
  modes.flip *= 2 * excess;
  modes.twist *= 2 * excess;
  return positive_part(svd, modes);
}

/// The constants of Smith et al. (2018), section 3.4, for the same small strains.
struct NeoHookean {
  double mu, lambda, alpha;
  explicit NeoHookean(const Moduli& m)
      : mu(4.0 / 3 * m.mu), lambda(2 * m.lambda + 5.0 / 6 * m.mu), alpha(1 + mu / lambda - mu / (4 * lambda)) {}
};

}  // namespace

Matrix3d activation_stretch(const Vector6d& a) {
  Matrix3d S;
  S << a[0], a[3], a[4], a[3], a[1], a[5], a[4], a[5], a[2];
  return S;
}

Vector6d activation_of(const Matrix3d& S) {
  return (Vector6d() << S(0, 0), S(1, 1), S(2, 2), S(0, 1), S(0, 2), S(1, 2)).finished();
}

Vector6d neutral_activation() {
  return activation_of(Matrix3d::Identity());
}

Matrix3d fibre_stretch(const Vector3d& fibre, double contraction) {
  return Matrix3d::Identity() + (contraction - 1) * fibre * fibre.transpose();
}

double corotated_energy(const Matrix3d& F, const Matrix3d& S, const Moduli& m) {
  const double excess = F.determinant() - S.determinant();
  return m.mu * shape_energy(F, S) + m.lambda * excess * excess;
}

Matrix3d corotated_stress(const Matrix3d& F, const Matrix3d& S, const Moduli& m) {
  return m.mu * shape_gradient(F, S) + 2 * m.lambda * (F.determinant() - S.determinant()) * cofactor(F);
}

Matrix9d corotated_stiffness(const Matrix3d& F, const Matrix3d& S, const Moduli& m, Stiffness kind) {
  const Matrix9d shape = kind == Stiffness::exact ? shape_hessian(F, S) : shape_projected_hessian(F, S);
  return m.mu * shape + m.lambda * volume_stiffness(F, S.determinant(), kind);
}

Matrix9x6d corotated_stress_by_activation(const Matrix3d& F, const Matrix3d& S, const Moduli& m) {
  const Vector9d C = vec(cofactor(F));
  const Matrix3d cofactor_of_S = cofactor(S);
  Matrix9x6d derivative;
  for (int k = 0; k < 6; ++k) {
    const Matrix3d dS = activation_stretch(Vector6d::Unit(k));
    derivative.col(k) =
        m.mu * vec(shape_gradient_by_stretch(F, S, dS)) - 2 * m.lambda * cofactor_of_S.cwiseProduct(dS).sum() * C;
  }
  return derivative;
}

double neo_hookean_energy(const Matrix3d& F, const Moduli& m) {
  const NeoHookean n(m);
  const double I = F.squaredNorm(), excess = F.determinant() - n.alpha, at_rest = 1 - n.alpha;
  return 0.5 * n.mu * (I - 3 - std::log((I + 1) / 4)) + 0.5 * n.lambda * (excess * excess - at_rest * at_rest);
}

Matrix3d neo_hookean_stress(const Matrix3d& F, const Moduli& m) {
  const NeoHookean n(m);
  return n.mu * (1 - 1 / (F.squaredNorm() + 1)) * F + n.lambda * (F.determinant() - n.alpha) * cofactor(F);
}

Matrix9d neo_hookean_stiffness(const Matrix3d& F, const Moduli& m, Stiffness kind) {
  const NeoHookean n(m);
  const double I = F.squaredNorm() + 1, excess = F.determinant() - n.alpha;
  const double stiff = n.mu * (1 - 1 / I), growth = 2 * n.mu / (I * I);
  if (kind == Stiffness::exact) {
    const Vector9d f = vec(F), c = vec(cofactor(F));
    return stiff * Matrix9d::Identity() + growth * f * f.transpose() + n.lambda * c * c.transpose() +
           n.lambda * excess * determinant_hessian(F);
  }
  const Svd3 svd = svd3(F);
  const Vector3d c(svd.s[1] * svd.s[2], svd.s[2] * svd.s[0], svd.s[0] * svd.s[1]);
  Modes modes = determinant_modes(svd.s);
  modes.scaling = stiff * Matrix3d::Identity() + growth * svd.s * svd.s.transpose() +
                  n.lambda * (c * c.transpose() + excess * modes.scaling);
  modes.flip = Vector3d::Constant(stiff) + n.lambda * excess * modes.flip;
  modes.twist = Vector3d::Constant(stiff) + n.lambda * excess * modes.twist;
  return positive_part(svd, modes);
}

}  // namespace phiz
