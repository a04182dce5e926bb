// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>

#include "phiz/core/random.h"
#include "phiz/elasticity/coulomb.h"

namespace phiz {
namespace {

TEST(Coulomb, MultipliersObeyTheLawOfDryFriction) {
  Random random(11);
  int open = 0, sticking = 0, sliding = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const Eigen::Index contacts = 1 + trial % 12;
    Eigen::MatrixXd B(3 * contacts, 3 * contacts);
    Eigen::VectorXd q(3 * contacts), y;
    for (double& value : B.reshaped()) value = random.normal();
    for (double& value : q) value = random.normal();
    const Eigen::MatrixXd M =
        B * B.transpose() + 3.0 * static_cast<double>(contacts) * Eigen::MatrixXd::Identity(q.size(), q.size());
    const double mu = 0.1 + 0.1 * (trial % 7);
    ASSERT_TRUE(solve_coulomb(M, q, mu, y)) << trial;
    const Eigen::VectorXd w = M * y + q;
    for (Eigen::Index i = 0; i < contacts; ++i) {
      const double pressure = y[3 * i], limit = mu * pressure;
      const Eigen::Vector2d friction = y.segment<2>(3 * i + 1), slip = w.segment<2>(3 * i + 1);
      EXPECT_GE(pressure, 0);
      EXPECT_GT(w[3 * i], -1e-9);
      EXPECT_NEAR(pressure * w[3 * i], 0, 1e-9);
      EXPECT_LE(friction.norm(), limit + 1e-12);
      EXPECT_NEAR(slip.dot(friction), -limit * slip.norm(), 1e-9);
      ++(pressure == 0 ? open : slip.norm() < 1e-9 ? sticking : sliding);
    }
  }
  EXPECT_GT(std::min({open, sticking, sliding}), 20);
}

}  // namespace
}  // namespace phiz
