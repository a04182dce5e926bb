// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "phiz/core/error.h"
#include "phiz/core/random.h"
#include "phiz/elasticity/muscle_prior.h"

namespace phiz {
namespace {

Vector3d random_direction(Random& random) {
  return Vector3d::NullaryExpr([&](auto) { return random.normal(); }).normalized();
}

/// Two muscles that share the middle one of three tets.
struct TwoMuscles {
  VectorXi tets = Eigen::Vector3i(2, 5, 6);
  VectorXd volumes = VectorXd::LinSpaced(8, 1e-9, 3e-9);
  std::vector<MuscleFibres> fibres = std::vector<MuscleFibres>(2);

  explicit TwoMuscles(Random& random) {
    fibres[0] = {Eigen::Vector2i(2, 5), Eigen::Vector2d(0.9, 0.3), MatrixX3d(2, 3)};
    fibres[1] = {Eigen::Vector2i(5, 6), Eigen::Vector2d(0.5, 0.8), MatrixX3d(2, 3)};
    for (MuscleFibres& muscle : fibres)
      for (int i = 0; i < 2; ++i) muscle.direction.row(i) = random_direction(random);
  }
};

TEST(MusclePrior, ContractionIsTheBestOfAll) {
  Random random(7);
  for (int round = 0; round < 2000; ++round) {
    // Beyond a few percent from rest the sextic may have three positive roots.
    const double spread = round % 2 == 0 ? 0.2 : 1.5;
    double p = 0, q = 0, r = 0;
    for (int i = 0; i < 5; ++i) {
      const double f = random.uniform();
      const Vector3d d = random_direction(random);
      const Vector6d a =
          neutral_activation() + spread * Vector6d::NullaryExpr([&](auto) { return random.uniform(-1, 1); });
      const Matrix3d S = activation_stretch(a);
      p += f;
      q += f * d.dot(S * d);
      r += f * (S.trace() - d.dot(S * d));
    }
    const auto objective = [&](double gamma) {
      return p * gamma * gamma - 2 * q * gamma + 2 * p / gamma - 2 * r / std::sqrt(gamma);
    };
    const double found = best_contraction(p, q, r);
    ASSERT_GT(found, 0);
    double least = objective(0.02);
    for (double gamma = 0.02; gamma < 50; gamma *= 1.001) least = std::min(least, objective(gamma));
    EXPECT_LE(objective(found), least + 1e-12 * p) << p << " " << q << " " << r;
  }
  EXPECT_NEAR(best_contraction(0.7, 0.7, 1.4), 1, 1e-14);
  EXPECT_EQ(best_contraction(0, 0, 0), 1);
}

TEST(MusclePrior, ContractedStretchKeepsVolumeAndIsFoundAgain) {
  Random random(8);
  for (const double gamma : {0.5, 0.8, 1.0, 1.3}) {
    const Vector3d d = random_direction(random);
    const Matrix3d S = contracted_stretch(d, gamma);
    EXPECT_NEAR(S.determinant(), 1, 1e-14);
    EXPECT_NEAR((S * d - gamma * d).norm(), 0, 1e-14);
    EXPECT_NEAR(best_contraction(0.3, 0.3 * d.dot(S * d), 0.3 * (S.trace() - d.dot(S * d))), gamma, 1e-12);
  }
}

TEST(MusclePrior, DirectionIsZeroForMusclesThatContractAndSparsityForThoseAtRest) {
  Random random(9);
  const TwoMuscles body(random);
  // The first tet belongs to one muscle, the others contract along what the second has there.
  const std::vector<MuscleFibres> second = {body.fibres[1]};
  Activations a = neutral_activation().replicate(1, 3);
  for (int i = 0; i < 2; ++i)
    a.col(i + 1) = activation_of(contracted_stretch(body.fibres[1].direction.row(i).transpose(), 0.8));
  MusclePrior direction(second, body.tets, body.volumes, {1, 0, 1e-300});
  EXPECT_GT(direction.value(a), 1e-3);
  direction.fit(a);
  EXPECT_NEAR(direction.contractions()[0], 0.8, 1e-12);
  EXPECT_NEAR(direction.value(a), 0, 1e-24);
  a(3, 1) += 0.1;
  direction.fit(a);
  EXPECT_GT(direction.value(a), 1e-4);

  const Activations rest = neutral_activation().replicate(1, 3);
  const MusclePrior sparsity(body.fibres, body.tets, body.volumes, {0, 1, 1e-300});
  EXPECT_NEAR(sparsity.gradient(rest).norm(), 0, 1e-15);
  // One muscle alone, and the same activity in both: the root of the share favours one.
  EXPECT_LT(sparsity.value(rest), 3e-3);
}

TEST(MusclePrior, GradientAgreesWithDifferencesAndCurvatureBoundsTheValue) {
  Random random(10);
  const TwoMuscles body(random);
  MusclePrior prior(body.fibres, body.tets, body.volumes, {0.7, 0.4, 0.1});
  const auto shaken = [&](double by) {
    return Activations(neutral_activation().replicate(1, 3) +
                       by * Activations::NullaryExpr(6, 3, [&] { return random.uniform(-1, 1); }));
  };
  for (int round = 0; round < 20; ++round) {
    const Activations a = shaken(round < 10 ? 0.06 : 0.9);  // the latter beyond the bounds of stretches
    prior.fit(a);
    const Activations g = prior.gradient(a), bound = prior.curvature(a);
    for (Eigen::Index k = 0; k < a.size(); ++k) {
      constexpr double h = 1e-6;
      Activations more = a, less = a;
      more.data()[k] += h;
      less.data()[k] -= h;
      EXPECT_NEAR(g.data()[k], (prior.value(more) - prior.value(less)) / (2 * h), 1e-6);
    }
    if (round >= 10) continue;
    const Activations step = shaken(0.06) - neutral_activation().replicate(1, 3);
    EXPECT_LE(prior.value(a + step),
              prior.value(a) + g.cwiseProduct(step).sum() + 0.5 * bound.cwiseProduct(step.cwiseAbs2()).sum() + 1e-12);
  }
}

TEST(MusclePrior, CurvatureIsThatOfTheValueWithTheBestContractionsNearTheSolution) {
  Random random(12);
  const TwoMuscles body(random);
  // Apart from one another, so that both can be as they would: no residual, where Gauss and Newton are exact.
  const std::vector<MuscleFibres> one = {body.fibres[0]};
  MusclePrior prior(one, body.tets, body.volumes, {0.7, 0, 1e-12});
  Activations a = neutral_activation().replicate(1, 3);
  for (int i = 0; i < 2; ++i)
    a.col(i) = activation_of(contracted_stretch(body.fibres[0].direction.row(i).transpose(), 0.8));
  const Activations v = Activations::NullaryExpr(6, 3, [&] { return random.uniform(-1, 1); });
  const auto best = [&](double h) {
    prior.fit(a + h * v);
    return prior.value(a + h * v);
  };
  constexpr double h = 1e-4;
  const double expected = (best(h) - 2 * best(0) + best(-h)) / (h * h);
  prior.fit(a);
  EXPECT_NEAR(prior.curvature_times(prior.curvature(a), v).cwiseProduct(v).sum(), expected, 1e-5 * expected);
  EXPECT_GT(prior.curvature(a).cwiseProduct(v.cwiseAbs2()).sum(), 1.001 * expected);
}

TEST(MusclePrior, RefusesNonsense) {
  Random random(11);
  TwoMuscles body(random);
  EXPECT_THROW(MusclePrior(body.fibres, body.tets, body.volumes, {-1, 0, 1}), Error);
  EXPECT_THROW(MusclePrior(body.fibres, body.tets, body.volumes, {1, 0, 0}), Error);
  body.fibres[0].fraction[0] = std::nan("");
  EXPECT_THROW(MusclePrior(body.fibres, body.tets, body.volumes, {}), Error);
  body.fibres[0].fraction = VectorXd::Ones(1);
  EXPECT_THROW(MusclePrior(body.fibres, body.tets, body.volumes, {}), Error);
}

}  // namespace
}  // namespace phiz
