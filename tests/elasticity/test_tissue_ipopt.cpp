// SPDX-License-Identifier: GPL-3.0-or-later
// Two solvers that share no more than energy and planes must find the same state.
#include <gtest/gtest.h>

#include <cmath>

#include "elasticity/tissue_blocks.h"
#include "phiz/elasticity/tissue_ipopt.h"
#include "phiz/elasticity/tissue_newton.h"

namespace phiz {
namespace {

using testing::block;
using testing::breadth;
using testing::depth;
using testing::everywhere;
using testing::length;
using testing::pin;
using testing::rigid_box;
using testing::slide;
using testing::vertices_where;
using testing::weigh;

void expect_agreement(const TissueEnergy& energy, const MatrixX3d& from, ContactScene* contacts, int& pushing) {
  MatrixX3d x = from, y = from;
  std::vector<ContactForce> newton_forces, forces;
  const SolveStatistics newton = solve_static(energy, x, {}, contacts, &newton_forces);
  const SolveStatistics ipopt = solve_static_with_ipopt(energy, y, {}, contacts, &forces);
  EXPECT_TRUE(newton.converged) << brief_report(newton);
  EXPECT_TRUE(ipopt.converged) << brief_report(ipopt);
  EXPECT_NEAR(newton.energy, ipopt.energy, 1e-6 * std::abs(newton.energy));
  EXPECT_LT((x - y).cwiseAbs().maxCoeff(), 1e-6);
  const MatrixX3d push = sum_of_contact_forces(newton_forces, x.rows());
  EXPECT_LE((push - sum_of_contact_forces(forces, x.rows())).norm(), 1e-4 * push.norm());  // the barrier leaves a trace
  pushing = ipopt.contacts;
}

TEST(Ipopt, AgreesWithNewtonOnAHangingMuscle) {
  TissueBody body = block();
  weigh(body, {2, -9.81, 0});
  body.active = VectorXd::LinSpaced(body.tets.rows(), 0, 1);
  pin(body, [](const Vector3d& p) { return p.y() == breadth; });
  slide(body, 0, 0, [](const Vector3d& p) { return p.x() == 0 && p.y() < breadth; });
  TissueEnergy energy(body);
  energy.set_activation(everywhere(body, Vector3d(0.7, 1.1, 1.2).asDiagonal()));
  int pushing = 0;
  expect_agreement(energy, body.rest, nullptr, pushing);
}

TEST(Ipopt, AgreesWithNewtonOnAPressedBlock) {
  TissueBody body = block();
  pin(body, [](const Vector3d& p) { return p.y() == 0; });
  ContactScene contacts(body.rest.rows());
  const int tool = contacts.add_rigid(rigid_box({-0.01, 0, -0.05}, {0.01, 0.02, 0.05}));
  contacts.place(tool, Eigen::Isometry3d(Eigen::Translation3d(0.5 * length, breadth + 0.001, 0)));
  contacts.add_pair(vertices_where(body, [](const Vector3d& p) { return p.y() == breadth; }), tool, -1, body.rest);
  Eigen::Isometry3d place(Eigen::Translation3d(0.5 * length, breadth - 0.002, 0));
  place.rotate(Eigen::AngleAxisd(0.05, Vector3d::UnitZ()));
  contacts.place(tool, place);
  const TissueEnergy energy(body);
  int pushing = 0;
  expect_agreement(energy, body.rest, &contacts, pushing);
  EXPECT_GT(pushing, 3);
}

TEST(Ipopt, AgreesWithNewtonOnABlockThatSlidesOverABowl) {
  TissueBody body = block();
  weigh(body, {3, 5, 1});
  for (Eigen::Index v = 0; v < body.rest.rows(); ++v) {
    if (body.rest(v, 1) != 0) continue;
    Slide held;
    held.vertex = static_cast<int>(v);
    held.point = body.rest.row(v);
    held.normal = Vector3d::UnitY();
    held.bend = Vector3d(15, 0, 10).asDiagonal();
    body.slides.push_back(held);
  }
  pin(body, [](const Vector3d& p) { return p.x() == 0 && p.y() == 0; });
  const TissueEnergy energy(body);
  int pushing = 0;
  expect_agreement(energy, body.rest, nullptr, pushing);
}

}  // namespace
}  // namespace phiz
