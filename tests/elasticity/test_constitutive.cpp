// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <functional>
#include <vector>

#include "phiz/core/random.h"
#include "phiz/elasticity/constitutive.h"

namespace phiz {
namespace {

constexpr Moduli moduli{1, 3};

struct Law {
  const char* name;
  std::function<double(const Matrix3d&, const Matrix3d&)> energy;
  std::function<Matrix3d(const Matrix3d&, const Matrix3d&)> stress;
  std::function<Matrix9d(const Matrix3d&, const Matrix3d&, Stiffness)> stiffness;
};

const std::vector<Law> laws{
    {"co-rotated", [](const Matrix3d& F, const Matrix3d& S) { return corotated_energy(F, S, moduli); },
     [](const Matrix3d& F, const Matrix3d& S) { return corotated_stress(F, S, moduli); },
     [](const Matrix3d& F, const Matrix3d& S, Stiffness kind) { return corotated_stiffness(F, S, moduli, kind); }},
    {"Neo-Hookean", [](const Matrix3d& F, const Matrix3d&) { return neo_hookean_energy(F, moduli); },
     [](const Matrix3d& F, const Matrix3d&) { return neo_hookean_stress(F, moduli); },
     [](const Matrix3d& F, const Matrix3d&, Stiffness kind) { return neo_hookean_stiffness(F, moduli, kind); }}};

Matrix3d rotation(Random& random) {
  return Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal())
      .normalized()
      .toRotationMatrix();
}

/// Gradients of tets that are bent, squashed, flat, turned over and collapsed, away from where R(F S) jumps.
std::vector<Matrix3d> states(Random& random) {
  std::vector<Matrix3d> all;
  for (const Vector3d& s : {Vector3d(1.1, 1, 0.9), Vector3d(2.5, 1.2, 0.3), Vector3d(1.4, 0.9, 1e-4),
                            Vector3d(1.2, 0.9, -0.3), Vector3d(2, 1, -0.7), Vector3d(0.3, 0.2, 0.05)})
    for (int k = 0; k < 5; ++k) all.push_back(rotation(random) * s.asDiagonal() * rotation(random));
  return all;
}

Matrix3d some_stretch(Random& random) {
  const Matrix3d Q = rotation(random);
  const Vector3d s(random.uniform(0.6, 0.9), random.uniform(1, 1.3), random.uniform(0.9, 1.2));
  return Q * s.asDiagonal() * Q.transpose();
}

Matrix3d unit(int k) {
  Matrix3d E = Matrix3d::Zero();
  E.data()[k] = 1;
  return E;
}

TEST(Constitutive, StressAndStiffnessAgreeWithFiniteDifferencesInEveryState) {
  Random random(11);
  constexpr double h = 1e-6;
  for (const Law& law : laws)
    for (const Matrix3d& F : states(random)) {
      const Matrix3d S = some_stretch(random);
      const Matrix3d P = law.stress(F, S);
      const Matrix9d H = law.stiffness(F, S, Stiffness::exact);
      for (int k = 0; k < 9; ++k) {
        const Matrix3d ahead = F + h * unit(k), back = F - h * unit(k);
        EXPECT_NEAR((law.energy(ahead, S) - law.energy(back, S)) / (2 * h), P.data()[k], 1e-6 * (1 + P.norm()))
            << law.name << "\n"
            << F;
        const Matrix3d column = (law.stress(ahead, S) - law.stress(back, S)) / (2 * h);
        EXPECT_LT((Eigen::Map<const Eigen::Matrix<double, 9, 1>>(column.data()) - H.col(k)).norm(), 1e-6 * H.norm())
            << law.name << "\n"
            << F;
      }
    }
}

TEST(Constitutive, StressByActivationAgreesWithFiniteDifferences) {
  Random random(12);
  constexpr double h = 1e-6;
  for (const Matrix3d& F : states(random)) {
    const Vector6d a = activation_of(some_stretch(random));
    const Matrix9x6d derivative = corotated_stress_by_activation(F, activation_stretch(a), moduli);
    for (int k = 0; k < 6; ++k) {
      const Vector6d d = h * Vector6d::Unit(k);
      const Matrix3d column = (corotated_stress(F, activation_stretch(a + d), moduli) -
                               corotated_stress(F, activation_stretch(a - d), moduli)) /
                              (2 * h);
      EXPECT_LT((Eigen::Map<const Eigen::Matrix<double, 9, 1>>(column.data()) - derivative.col(k)).norm(),
                1e-6 * derivative.norm());
    }
  }
}

TEST(Constitutive, ProjectedStiffnessIsPositiveAndExactWhereNothingWasNegative) {
  Random random(13);
  for (const Law& law : laws) {
    int negative = 0;
    for (const Matrix3d& F : states(random)) {
      const Matrix3d S = some_stretch(random);
      const Matrix9d exact = law.stiffness(F, S, Stiffness::exact);
      const Matrix9d projected = law.stiffness(F, S, Stiffness::projected);
      EXPECT_LT((projected - projected.transpose()).norm(), 1e-10 * projected.norm());
      const double least = Eigen::SelfAdjointEigenSolver<Matrix9d>(projected).eigenvalues().minCoeff();
      EXPECT_GT(least, -1e-10 * projected.norm()) << law.name;
      // What was removed was negative.
      const double removed = Eigen::SelfAdjointEigenSolver<Matrix9d>(projected - exact).eigenvalues().minCoeff();
      EXPECT_GT(removed, -1e-9 * (1 + exact.norm())) << law.name;
      negative += Eigen::SelfAdjointEigenSolver<Matrix9d>(exact).eigenvalues().minCoeff() < 0;
    }
    EXPECT_GT(negative, 0) << law.name << ": the states are hard enough";
    const Matrix3d R = rotation(random), I = Matrix3d::Identity();
    EXPECT_LT((law.stiffness(R, I, Stiffness::projected) - law.stiffness(R, I, Stiffness::exact)).norm(), 1e-10);
  }
}

TEST(Constitutive, EnergyIsInvariantUnderRotationAndZeroAtRest) {
  Random random(14);
  const Matrix3d I = Matrix3d::Identity();
  for (const Law& law : laws) {
    for (const Matrix3d& F : states(random)) {
      const Matrix3d S = some_stretch(random);
      const double energy = law.energy(F, S);
      EXPECT_NEAR(law.energy(rotation(random) * F, S), energy, 1e-10 * (1 + energy));
      EXPECT_GE(energy, 0);
    }
    EXPECT_NEAR(law.energy(rotation(random), I), 0, 1e-12);
    EXPECT_LT(law.stress(rotation(random), I).norm(), 1e-12) << law.name;
  }
}

TEST(Constitutive, AnActivatedTetRestsAtItsStretchAndPullsNoTorque) {
  Random random(15);
  for (const Matrix3d& F : states(random)) {
    const Matrix3d S = some_stretch(random);
    EXPECT_NEAR(corotated_energy(rotation(random) * S, S, moduli), 0, 1e-12);
    EXPECT_LT(corotated_stress(rotation(random) * S, S, moduli).norm(), 1e-12);
    // P F^T is symmetric: the forces of the tet have no torque (phace.md, 15.3, test 4).
    const Matrix3d kirchhoff = corotated_stress(F, S, moduli) * F.transpose();
    EXPECT_LT((kirchhoff - kirchhoff.transpose()).norm(), 1e-12 * (1 + kirchhoff.norm()));
  }
}

TEST(Constitutive, LawsAgreeAtSmallStrains) {
  const Matrix3d I = Matrix3d::Identity();
  const Matrix9d a = corotated_stiffness(I, I, moduli, Stiffness::exact);
  const Matrix9d b = neo_hookean_stiffness(I, moduli, Stiffness::exact);
  EXPECT_LT((a - b).norm(), 1e-12);
  // 2 mu_L e + lambda_L tr(e) I with Lame's constants mu and 2 lambda.
  Matrix3d e;
  e << 0.1, 0.2, 0, 0.2, -0.3, 0.1, 0, 0.1, 0.4;
  const Eigen::Matrix<double, 9, 1> stress = a * Eigen::Map<const Eigen::Matrix<double, 9, 1>>(e.data());
  const Matrix3d expected = 2 * moduli.mu * e + 2 * moduli.lambda * e.trace() * I;
  EXPECT_LT((stress - Eigen::Map<const Eigen::Matrix<double, 9, 1>>(expected.data())).norm(), 1e-12);
}

TEST(Constitutive, ActivationsAreTheEntriesOfASymmetricStretch) {
  Vector6d a;
  a << 1, 2, 3, 4, 5, 6;
  const Matrix3d S = activation_stretch(a);
  EXPECT_EQ(S, S.transpose());
  EXPECT_EQ(activation_of(S), a);
  EXPECT_EQ(activation_stretch(neutral_activation()), Matrix3d::Identity());
  const Vector3d d = Vector3d(1, 2, 2) / 3;
  const Matrix3d fibre = fibre_stretch(d, 0.7);
  EXPECT_LT((fibre * d - 0.7 * d).norm(), 1e-15);
  EXPECT_NEAR(fibre.determinant(), 0.7, 1e-14);
}

}  // namespace
}  // namespace phiz
