// SPDX-License-Identifier: GPL-3.0-or-later
// Contact of the reference engine: conditions of a constrained minimum and closed-form cases (phace.md section 15.3).
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "elasticity/contact_scenes.h"
#include "elasticity/tissue_blocks.h"
#include "phiz/core/parallel.h"
#include "phiz/elasticity/tissue_newton.h"

namespace phiz {
namespace {

using testing::block;
using testing::box;
using testing::breadth;
using testing::depth;
using testing::flatter;
using testing::Floor;
using testing::length;
using testing::Lips;
using testing::pin;
using testing::rigid_box;
using testing::shaken;
using testing::slide;
using testing::tissue_of;
using testing::total_volume;
using testing::vertices_where;
using testing::weigh;

struct Solved {
  MatrixX3d x;
  SolveStatistics statistics;
  std::vector<ContactForce> forces;
};

Solved solve(const TissueEnergy& energy, const MatrixX3d& from, ContactScene* contacts,
             const NewtonStaticOptions& options = {}) {
  Solved out;
  out.x = from;
  out.statistics = solve_static(energy, out.x, options, contacts, &out.forces);
  return out;
}

/// The conditions of a constrained minimum, looked at from outside: forces balance, contacts push, and only where they
/// touch.
void expect_equilibrium(const TissueEnergy& energy, const Solved& solved, double friction = 0) {
  EXPECT_TRUE(solved.statistics.converged) << brief_report(solved.statistics);
  VectorXd magnitude;
  const MatrixX3d force = energy.gradient(solved.x, &magnitude) - sum_of_contact_forces(solved.forces, solved.x.rows());
  EXPECT_LT(FreeMotion(energy.body(), solved.x).reduced(force).norm(), 1e-7 * magnitude.norm());
  for (const ContactForce& contact : solved.forces) {
    EXPECT_GE(contact.pressure, 0);
    EXPECT_NEAR(contact.row.gap, 0, 1e-8);
    EXPECT_NEAR(contact.friction.dot(contact.row.normal), 0, 1e-12);
    EXPECT_LE(contact.friction.norm(), friction * contact.pressure * (1 + 1e-9));
  }
}

TEST(TissueContact, TheFloorCarriesTheWeightOfABlockThatSags) {
  Floor on({0, -9.81, 0});
  // What the floor does not hold: two directions and a turn.
  slide(on.body, 0, 0, [](const Vector3d& p) { return p.x() == 0 && p.y() == breadth; });
  slide(on.body, 2, 0, [](const Vector3d& p) { return p.x() == 0 && p.y() == breadth && p.z() == 0; });
  const TissueEnergy energy(on.body);
  const Solved solved = solve(energy, on.body.rest, &on.contacts);
  expect_equilibrium(energy, solved);
  const double weight = 1000 * length * breadth * depth * 9.81;
  double carried = 0;
  for (const ContactForce& contact : solved.forces) carried += contact.pressure * contact.row.normal.y();
  EXPECT_NEAR(carried, weight, 1e-7 * weight);
  EXPECT_LT(on.contacts.penetration(solved.x), 1e-9);
  EXPECT_LT(solved.x.col(1).maxCoeff(), breadth - 1e-4) << "it sags";
}

TEST(TissueContact, ABlockBetweenTwoPlatesKeepsItsVolumeAndItsDistance) {
  TissueBody body = block({1000, 1e5});
  ContactScene contacts(body.rest.rows());
  const int below = contacts.add_rigid(rigid_box({-0.1, -0.05, -0.1}, {0.2, 0, 0.2}, 3));
  const int above = contacts.add_rigid(rigid_box({-0.1, 0, -0.1}, {0.2, 0.05, 0.2}, 3));
  contacts.place(above, Eigen::Isometry3d(Eigen::Translation3d(0, breadth, 0)));
  contacts.add_pair(vertices_where(body, [](const Vector3d& p) { return p.y() == 0; }), below, -1, flatter(body));
  contacts.add_pair(vertices_where(body, [](const Vector3d& p) { return p.y() == breadth; }), above, -1, flatter(body));
  slide(body, 0, 0, [](const Vector3d& p) { return p.x() == 0.5 * length; });
  slide(body, 2, 0, [](const Vector3d& p) { return p.z() == 0.5 * depth; });
  const TissueEnergy energy(body);
  Solved solved{body.rest, {}, {}};
  for (const double squeeze : {0.002, 0.005}) {
    contacts.place(above, Eigen::Isometry3d(Eigen::Translation3d(0, breadth - squeeze, 0)));
    solved = solve(energy, solved.x, &contacts);
    expect_equilibrium(energy, solved);
    EXPECT_LT(contacts.penetration(solved.x), 1e-8);
    EXPECT_NEAR(solved.x.col(1).maxCoeff() - solved.x.col(1).minCoeff(), breadth - squeeze, 1e-8);
    EXPECT_LT(std::abs(total_volume(body, solved.x) / total_volume(body, body.rest) - 1), 0.01);
  }
  double up = 0, down = 0;
  for (const ContactForce& contact : solved.forces)
    (contact.row.normal.y() > 0 ? up : down) += contact.pressure * contact.row.normal.y();
  EXPECT_NEAR(up, -down, 1e-7 * up);
}

TEST(TissueContact, ThePressOfAFlatPlateIsTheClosedFormOfUniaxialStretch) {
  constexpr double squeeze = 0.9;
  TissueBody body = block();
  slide(body, 0, 0, [](const Vector3d& p) { return p.x() == 0; });
  slide(body, 1, 0, [](const Vector3d& p) { return p.y() == 0; });
  slide(body, 2, 0, [](const Vector3d& p) { return p.z() == 0; });
  ContactScene contacts(body.rest.rows());
  const int plate = contacts.add_rigid(rigid_box({-0.1, breadth, -0.1}, {0.2, 0.1, 0.2}));
  contacts.add_pair(vertices_where(body, [](const Vector3d& p) { return p.y() == breadth; }), plate, -1, flatter(body));
  contacts.place(plate, Eigen::Isometry3d(Eigen::Translation3d(0, (squeeze - 1) * breadth, 0)));
  const TissueEnergy energy(body);
  const Solved solved = solve(energy, body.rest, &contacts);
  expect_equilibrium(energy, solved);
  // b across, from d/db [mu ((a-1)^2 + 2 (b-1)^2) + lambda (a b^2 - 1)^2] = 0.
  const auto [mu, lambda] = testing::flesh;
  double low = 1, high = 1.5;
  for (int k = 0; k < 100; ++k) {
    const double b = 0.5 * (low + high);
    (mu * (b - 1) + lambda * (squeeze * b * b - 1) * squeeze * b > 0 ? high : low) = b;
  }
  const Matrix3d F = Vector3d(low, squeeze, low).asDiagonal();
  EXPECT_LT((solved.x - body.rest * F.transpose()).cwiseAbs().maxCoeff(), 1e-8);
  double press = 0;
  for (const ContactForce& contact : solved.forces) press += contact.pressure;
  const double expected =
      length * depth * (2 * mu * (1 - squeeze) + 2 * lambda * (1 - squeeze * low * low) * low * low);
  EXPECT_NEAR(press, expected, 1e-7 * expected);
}

TEST(TissueContact, TwoSoftBlocksMeetAndPushEachOtherWithOppositeForces) {
  const Lips lips;
  ContactScene contacts = lips.scene();
  const TissueEnergy energy(lips.body);
  Solved solved{lips.body.rest, {}, {}};
  for (const double down : {1e-3, 2e-3}) {
    solved = solve(energy, lips.pressed(solved.x, down, 0.3 * down), &contacts);
    expect_equilibrium(energy, solved);
    EXPECT_GT(solved.forces.size(), 10U);
    EXPECT_LT(contacts.penetration(solved.x), 1e-6);
  }
  const MatrixX3d push = sum_of_contact_forces(solved.forces, solved.x.rows());
  const Vector3d below = push.topRows(lips.split).colwise().sum();
  const Vector3d above = push.bottomRows(push.rows() - lips.split).colwise().sum();
  EXPECT_LT((below + above).norm(), 1e-10 * below.norm());
  EXPECT_LT(below.y(), 0);
}

TEST(TissueContact, RoundsOfPlanesSettleToAsManyDigitsAsAreAskedFor) {
  const Lips lips;
  const TissueEnergy energy(lips.body);
  ContactScene contacts = lips.scene();
  const MatrixX3d start = lips.pressed(lips.body.rest, 1.5e-3, 4e-4);
  const Solved usual = solve(energy, start, &contacts);
  NewtonStaticOptions options;
  options.state_tolerance = 1e-11;
  const Solved strict = solve(energy, start, &contacts, options);
  EXPECT_TRUE(strict.statistics.converged) << brief_report(strict.statistics);
  EXPECT_LT((usual.x - strict.x).cwiseAbs().maxCoeff(), 3 * NewtonStaticOptions().state_tolerance);
  EXPECT_LT(contacts.penetration(strict.x), 1e-11);
  // From there nothing is left to do.
  const Solved again = solve(energy, strict.x, &contacts, options);
  EXPECT_LT((again.x - strict.x).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(TissueContact, TheEnergyFallsAndTheTraceSaysHow) {
  const Lips lips;
  ContactScene contacts = lips.scene();
  const TissueEnergy energy(lips.body);
  Trace trace;
  NewtonStaticOptions options;
  options.trace = &trace;
  const Solved solved = solve(energy, lips.pressed(lips.body.rest, 1.5e-3, 0), &contacts, options);
  ASSERT_EQ(trace.size(), static_cast<std::size_t>(solved.statistics.iterations));
  for (std::size_t k = 0; k + 1 < trace.size(); ++k) {
    EXPECT_GT(trace[k].step_length, 0);
    EXPECT_EQ(trace[k].iteration, static_cast<int>(k) + 1);
    EXPECT_GE(trace[k + 1].milliseconds, trace[k].milliseconds);
    // With planes that it does not penetrate a step may not raise the energy.
    if (trace[k].round == trace[k + 1].round && trace[k].violation <= 1e-12) {
      EXPECT_LE(trace[k + 1].energy, trace[k].energy * (1 + 1e-12));
    }
  }
  EXPECT_LT(solved.statistics.residual, 1e-8);
}

TEST(TissueContact, AScrambledBlockStillFindsTheFloor) {
  Floor on({0, -9.81, 0});
  on.body.passive = PassiveLaw::neo_hookean;
  slide(on.body, 0, 0, [](const Vector3d& p) { return p.x() == 0 && p.y() == breadth; });
  slide(on.body, 2, 0, [](const Vector3d& p) { return p.x() == 0 && p.y() == breadth && p.z() == 0; });
  const TissueEnergy energy(on.body);
  const Solved plain = solve(energy, on.body.rest, &on.contacts);
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    MatrixX3d x = shaken(on.body.rest, 0.003 * static_cast<double>(seed), seed);
    x.col(1) = x.col(1).cwiseMax(-0.004);
    const Solved solved = solve(energy, x, &on.contacts);
    expect_equilibrium(energy, solved);
    EXPECT_LT((solved.x - plain.x).cwiseAbs().maxCoeff(), 1e-6) << seed;
  }
}

TEST(TissueContact, AHeadsetPressesAlongItsNormalsAndLetsNoVertexIn) {
  TissueBody body = tissue_of(box({0, 0, 0}, {0.04, 0.015, 0.04}, 8, 3, 8));
  pin(body, [](const Vector3d& p) { return p.y() == 0; });
  ContactScene contacts(body.rest.rows());
  const int headset = contacts.add_rigid(rigid_box({-0.008, 0, -0.008}, {0.008, 0.02, 0.008}, 2));
  contacts.place(headset, Eigen::Isometry3d(Eigen::Translation3d(0.02, 0.016, 0.02)));
  contacts.add_pair(vertices_where(body, [](const Vector3d& p) { return p.y() == 0.015; }), headset, -1, body.rest);
  const TissueEnergy energy(body);
  Solved solved{body.rest, {}, {}};
  for (const double press : {0.001, 0.002, 0.003}) {
    Eigen::Isometry3d place(Eigen::Translation3d(0.02, 0.015 - press, 0.02));
    place.rotate(Eigen::AngleAxisd(0.1, Vector3d::UnitX()));
    contacts.place(headset, place);
    solved = solve(energy, solved.x, &contacts);
    expect_equilibrium(energy, solved);
    EXPECT_LT(contacts.penetration(solved.x), 1e-6);
    EXPECT_FALSE(solved.forces.empty());
  }
}

TEST(TissueContact, OneThreadAndTwoGiveTheSameBits) {
  const Lips lips;
  const TissueEnergy energy(lips.body);
  NewtonStaticOptions options;
  options.friction = 0.3;
  Solved results[2];
  for (int threads = 1; threads <= 2; ++threads) {
    const ThreadLimit limit(threads);
    ContactScene contacts = lips.scene();
    results[threads - 1] = solve(energy, lips.pressed(lips.body.rest, 1.2e-3, 3e-4), &contacts, options);
  }
  EXPECT_TRUE(results[0].x == results[1].x);
  EXPECT_EQ(results[0].statistics.energy, results[1].statistics.energy);
}

TEST(TissueContact, FrictionHoldsAPressedBlockUpToItsLimitAndSlidingOpposesTheMotion) {
  // A plate presses a block from above and the pins below move aside.
  TissueBody body = block();
  pin(body, [](const Vector3d& p) { return p.y() == 0; });
  ContactScene contacts(body.rest.rows());
  const int plate = contacts.add_rigid(rigid_box({-0.1, breadth, -0.1}, {0.2, 0.1, 0.2}));
  contacts.add_pair(vertices_where(body, [](const Vector3d& p) { return p.y() == breadth; }), plate, -1, flatter(body));
  contacts.place(plate, Eigen::Isometry3d(Eigen::Translation3d(0, -0.002, 0)));
  const TissueEnergy energy(body);
  const Solved pressed = solve(energy, body.rest, &contacts);
  expect_equilibrium(energy, pressed);
  NewtonStaticOptions options;
  options.friction = 0.4;
  for (const double aside : {2e-4, 1.2e-2}) {
    MatrixX3d x = pressed.x;
    options.friction_reference = x;
    for (Eigen::Index v = 0; v < x.rows(); ++v)
      if (body.pinned[static_cast<std::size_t>(v)] != 0) x(v, 0) += aside;
    const Solved solved = solve(energy, x, &contacts, options);
    expect_equilibrium(energy, solved, options.friction);
    int sliding = 0, sticking = 0;
    for (const ContactForce& contact : solved.forces) {
      const Vector3d slip = solved.x.row(contact.row.vertices[0]) - pressed.x.row(contact.row.vertices[0]);
      const Vector3d along = slip - slip.dot(contact.row.normal) * contact.row.normal;
      const double limit = options.friction * contact.pressure;
      if (contact.friction.norm() < limit * (1 - 1e-6)) {
        EXPECT_LT(along.norm(), 1e-8);
        ++sticking;
      } else if (along.norm() > 1e-7) {
        EXPECT_LT((contact.friction + limit * along.normalized()).norm(), 1e-5 * limit);
        ++sliding;
      }
    }
    EXPECT_GT(aside < 1e-3 ? sticking : sliding, 5) << sticking << " stick, " << sliding << " slide";
  }
}

TEST(TissueContact, ASqueezeThatCannotBeIsReported) {
  // Two plates whose gap is turned inside out.
  TissueBody body = block();
  ContactScene contacts(body.rest.rows());
  const int below = contacts.add_rigid(rigid_box({-0.1, -0.05, -0.1}, {0.2, 0, 0.2}));
  const int above = contacts.add_rigid(rigid_box({-0.1, 0, -0.1}, {0.2, 0.05, 0.2}));
  contacts.place(above, Eigen::Isometry3d(Eigen::Translation3d(0, breadth, 0)));
  const VectorXi outside = vertices_where(body, [](const Vector3d& p) { return p.y() == breadth; });
  contacts.add_pair(outside, below, -1, body.rest);
  contacts.add_pair(outside, above, -1, flatter(body));
  contacts.place(below, Eigen::Isometry3d(Eigen::Translation3d(0, breadth, 0)));
  contacts.place(above, Eigen::Isometry3d(Eigen::Translation3d(0, breadth - 0.002, 0)));
  pin(body, [](const Vector3d& p) { return p.y() == 0; });
  const TissueEnergy energy(body);
  NewtonStaticOptions options;
  options.max_iterations = 30;
  const Solved solved = solve(energy, body.rest, &contacts, options);
  EXPECT_FALSE(solved.statistics.converged);
  EXPECT_TRUE(solved.x.allFinite());
  EXPECT_GT(solved.statistics.penetration, 1e-4);
}

TEST(TissueContact, PinnedVerticesAreLeftWhereTheyAre) {
  TissueBody body = block();
  pin(body, [](const Vector3d& p) { return p.y() == 0 || (p.y() == breadth && p.x() == 0); });
  ContactScene contacts(body.rest.rows());
  const int plate = contacts.add_rigid(rigid_box({-0.1, breadth, -0.1}, {0.2, 0.1, 0.2}));
  contacts.add_pair(vertices_where(body, [](const Vector3d& p) { return p.y() == breadth; }), plate, -1, flatter(body));
  contacts.place(plate, Eigen::Isometry3d(Eigen::Translation3d(0, -0.001, 0)));
  const TissueEnergy energy(body);
  const Solved solved = solve(energy, body.rest, &contacts);
  EXPECT_LT(solved.statistics.residual, 1e-8);
  EXPECT_FALSE(solved.statistics.converged) << "the pins are inside";
  EXPECT_NEAR(solved.statistics.penetration, 0.001, 1e-9);
  for (Eigen::Index v = 0; v < body.rest.rows(); ++v) {
    if (body.pinned[static_cast<std::size_t>(v)] != 0) {
      EXPECT_EQ((solved.x.row(v) - body.rest.row(v)).norm(), 0);
    } else {
      EXPECT_LT(solved.x(v, 1), breadth - 0.001 + 1e-9);
    }
  }
}

TEST(TissueContact, SenselessOptionsAreRefused) {
  const TissueEnergy energy(block());
  MatrixX3d x = energy.body().rest;
  NewtonStaticOptions options;
  options.friction = -1;
  EXPECT_ANY_THROW(solve_static(energy, x, options));
  options.friction = 0.5;
  options.friction_reference = MatrixX3d::Zero(3, 3);
  EXPECT_ANY_THROW(solve_static(energy, x, options));
}

}  // namespace
}  // namespace phiz
