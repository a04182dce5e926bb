// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "elasticity/blocks.h"
#include "phiz/core/random.h"
#include "phiz/elasticity/complementarity.h"
#include "phiz/elasticity/contact.h"
#include "phiz/elasticity/projective_dynamics.h"
#include "phiz/geometry/topology.h"

namespace phiz {
namespace {

using testing::body_of;
using testing::box;

/// Two soft blocks, one above the other with a gap: lips. The far sides are held.
struct Lips {
  ElasticBody body;
  MatrixX3i upper_patch, lower_patch;
  VectorXi upper_vertices, lower_vertices;
  double gap = 5e-4;

  Lips() {
    const TetMesh lower = box({-0.02, -0.008, 0}, {0.02, 0, 0.01}, 10, 4, 4);
    const TetMesh upper = box({-0.023, gap, 0.001}, {0.023, 0.008 + gap, 0.011}, 11, 4, 4);
    TetMesh both;
    both.V.resize(lower.V.rows() + upper.V.rows(), 3);
    both.V << lower.V, upper.V;
    both.T.resize(lower.T.rows() + upper.T.rows(), 4);
    both.T << lower.T, (upper.T.array() + static_cast<int>(lower.V.rows())).matrix();
    body = body_of(both, {0.2, 1, 100}, [this](const Vector3d& p) { return p.y() < -0.0079 || p.y() > 0.0079 + gap; });
    // The patches are all of a block's outside but for its held side, so that their rims stay away from the contact.
    const MatrixX3i F = boundary_triangles(both.T);
    const auto outside = [&](bool of_upper, MatrixX3i& patch, VectorXi& vertices) {
      std::vector<int> rows, used;
      for (Eigen::Index f = 0; f < F.rows(); ++f)
        if ((F(f, 0) >= lower.V.rows()) == of_upper &&
            (both.V(F.row(f), 1).array() - 0.5 * gap).abs().minCoeff() < 0.0075)
          rows.push_back(static_cast<int>(f));
      patch = F(rows, Eigen::all);
      used.assign(patch.data(), patch.data() + patch.size());
      std::sort(used.begin(), used.end());
      used.erase(std::unique(used.begin(), used.end()), used.end());
      vertices = Eigen::Map<VectorXi>(used.data(), static_cast<Eigen::Index>(used.size()));
    };
    outside(false, lower_patch, lower_vertices);
    outside(true, upper_patch, upper_vertices);
  }

  ContactScene scene() const {
    ContactScene contacts(body.rest.rows());
    const int lower = contacts.add_patch(body.rest, lower_patch);
    const int upper = contacts.add_patch(body.rest, upper_patch);
    contacts.add_pair(upper_vertices, lower, upper, body.rest);
    contacts.add_pair(lower_vertices, upper, lower, body.rest);
    return contacts;
  }

  /// Moves the held side of the upper lip.
  void press(MatrixX3d& x, double down, double aside = 0) const {
    for (Eigen::Index v = 0; v < x.rows(); ++v)
      if (body.fixed[static_cast<std::size_t>(v)] && body.rest(v, 1) > 0)
        x.row(v) = body.rest.row(v) + Eigen::RowVector3d(aside, -down, 0);
  }
};

SolveOptions tight() {
  SolveOptions options;
  options.max_iterations = 400;
  options.step_tolerance = 1e-8;
  options.penetration_tolerance = 5e-7;
  return options;
}

TEST(Contact, PressedLipsDoNotPenetrateAndKeepTheirVolume) {
  const Lips lips;
  ContactScene contacts = lips.scene();
  ProjectiveDynamics solver(lips.body, contacts.candidates());
  constexpr double thickness = 8e-3;
  MatrixX3d x = lips.body.rest;
  for (int step = 1; step <= 8; ++step) {
    lips.press(x, 5e-4 * step, 2e-4 * step);
    const SolveStatistics statistics = solver.solve(x, tight(), &contacts);
    EXPECT_TRUE(statistics.converged) << brief_report(statistics);
    EXPECT_LT(contacts.penetration(x), 1e-4 * thickness);
  }
  EXPECT_LT(std::abs(solver.volume(x) / solver.rest_volume() - 1), 0.02);
  // Both lips gave way.
  double lowest = 1, highest = -1;
  for (const int v : lips.upper_vertices) lowest = std::min(lowest, x(v, 1));
  for (const int v : lips.lower_vertices) highest = std::max(highest, lips.body.rest(v, 1) - x(v, 1));
  EXPECT_LT(lowest, -5e-4);
  EXPECT_GT(highest, 5e-4);
}

TEST(Contact, LiftedLipsDoNotStick) {
  const Lips lips;
  ContactScene contacts = lips.scene();
  ProjectiveDynamics solver(lips.body, contacts.candidates());
  MatrixX3d pressed = lips.body.rest;
  lips.press(pressed, 2.5e-3);
  solver.solve(pressed, tight(), &contacts);
  lips.press(pressed, -1e-3);
  const SolveStatistics statistics = solver.solve(pressed, tight(), &contacts);
  EXPECT_EQ(statistics.contacts, 0);
  MatrixX3d free = lips.body.rest;
  lips.press(free, -1e-3);
  solver.solve(free, tight());
  EXPECT_LT((pressed - free).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(Contact, WithoutContactTheResultIsThePlainOneBitForBit) {
  const Lips lips;
  ContactScene contacts = lips.scene();
  ProjectiveDynamics solver(lips.body, contacts.candidates());
  MatrixX3d a = lips.body.rest, b = a;
  lips.press(a, -2e-3, 1e-3);
  lips.press(b, -2e-3, 1e-3);
  solver.solve(a, tight(), &contacts);
  solver.forget();
  solver.solve(b, tight());
  EXPECT_EQ((a - b).cwiseAbs().maxCoeff(), 0.0);
}

TEST(Contact, ARigidObstaclePushesAndFollowsItsPlacement) {
  const TetMesh mesh = box({0, 0, 0}, {0.03, 0.01, 0.03}, 8, 4, 8);
  const ElasticBody body = body_of(mesh, {0.2, 1, 30}, [](const Vector3d& p) { return p.y() < 1e-9; });
  const TetMesh tool = box({-0.004, 0, -0.004}, {0.004, 0.006, 0.004}, 1, 1, 1);
  ContactScene contacts(body.rest.rows());
  const int obstacle = contacts.add_rigid({tool.V, boundary_triangles(tool.T), {}, {}});
  contacts.place(obstacle, Eigen::Isometry3d(Eigen::Translation3d(0.015, 0.02, 0.015)));
  std::vector<int> top;
  for (int v = 0; v < body.rest.rows(); ++v)
    if (body.rest(v, 1) > 0.01 - 1e-9) top.push_back(v);
  contacts.add_pair(Eigen::Map<VectorXi>(top.data(), static_cast<Eigen::Index>(top.size())), obstacle, -1, body.rest);
  ProjectiveDynamics solver(body, contacts.candidates());
  MatrixX3d x = body.rest;
  for (int step = 1; step <= 4; ++step) {
    contacts.place(obstacle, Eigen::Isometry3d(Eigen::Translation3d(0.015, 0.01 - 5e-4 * step, 0.015)));
    const SolveStatistics statistics = solver.solve(x, tight(), &contacts);
    EXPECT_TRUE(statistics.converged) << brief_report(statistics);
    EXPECT_GT(statistics.contacts, 0);
    EXPECT_LT(contacts.penetration(x), 2e-6);
  }
  EXPECT_NEAR(x.col(1).maxCoeff(), 0.01, 2e-3);
}

TEST(Contact, AtRestForcesArePushesAlongTheNormalsOfTouchedPlanesAndVanishElsewhere) {
  // The conditions of a constrained minimum, on the solver's own state: gradient = C^T lambda, lambda >= 0.
  const TetMesh mesh = box({0, 0, 0}, {0.03, 0.01, 0.03}, 8, 4, 8);
  const ElasticBody body = body_of(mesh, {0.2, 1, 30}, [](const Vector3d& p) { return p.y() < 1e-9; });
  const TetMesh plate = box({-0.05, 0, -0.05}, {0.05, 0.01, 0.05}, 1, 1, 1);
  ContactScene contacts(body.rest.rows());
  const int obstacle = contacts.add_rigid({plate.V, boundary_triangles(plate.T), {}, {}});
  const Matrix3d tilt = Eigen::AngleAxisd(0.05, Vector3d::UnitZ()).toRotationMatrix();
  Eigen::Isometry3d placed(Eigen::Translation3d(0.015, 0.0095, 0.015));
  placed.linear() = tilt;
  contacts.place(obstacle, Eigen::Isometry3d(Eigen::Translation3d(0, 1, 0)));
  std::vector<int> top;
  for (int v = 0; v < body.rest.rows(); ++v)
    if (body.rest(v, 1) > 0.01 - 1e-9) top.push_back(v);
  contacts.add_pair(Eigen::Map<VectorXi>(top.data(), static_cast<Eigen::Index>(top.size())), obstacle, -1, body.rest);
  ProjectiveDynamics solver(body, contacts.candidates());
  contacts.place(obstacle, placed);
  MatrixX3d x = body.rest;
  SolveOptions exact = tight();
  exact.step_tolerance = 1e-10;
  exact.max_iterations = 2000;
  exact.penetration_tolerance = 1e-9;
  const SolveStatistics statistics = solver.solve(x, exact, &contacts);
  EXPECT_TRUE(statistics.converged) << brief_report(statistics);

  MatrixX3d gradient;
  solver.energy(x, &gradient);
  const double scale = gradient.rowwise().norm().maxCoeff();
  const Vector3d normal = -tilt.col(1);  // out of the plate's lower side
  int pushed = 0, free = 0;
  for (Eigen::Index v = 0; v < x.rows(); ++v) {
    if (body.fixed[static_cast<std::size_t>(v)]) continue;
    const double gap = normal.dot(Vector3d(x.row(v)) - placed.translation());
    const Vector3d force = gradient.row(v);
    const bool candidate = body.rest(v, 1) > 0.01 - 1e-9;
    if (candidate && force.norm() > 1e-5 * scale) {
      EXPECT_NEAR(gap, 0, 1e-9);                                             // it touches,
      EXPECT_GT(force.dot(normal), 0);                                       // is pushed,
      EXPECT_LT((force - force.dot(normal) * normal).norm(), 1e-5 * scale);  // and not held aside
      ++pushed;
    } else {
      EXPECT_LT(force.norm(), 1e-5 * scale);
      if (candidate) {
        EXPECT_GT(gap, -1e-9);
        ++free;
      }
    }
  }
  EXPECT_GT(pushed, 5);
  EXPECT_GT(free, 5);
}

/// Two leaves with a common edge along y, the seam; the second stands at `angle` from the first. Their outer sides face
/// each other when the angle is small.
struct Hinge {
  static constexpr int rows = 9, across = 3;
  static constexpr double spacing = 1e-3;
  MatrixX3i leaf, other_leaf;

  Hinge() : leaf(triangles(0)), other_leaf(triangles(rows * across)) {
    other_leaf = other_leaf.unaryExpr([](int v) { return on_seam(v) ? v - rows * across : v; });
    other_leaf.col(1).swap(other_leaf.col(2));
  }

  static bool on_seam(int v) { return v % across == 0 && v >= rows * across; }

  static MatrixX3i triangles(int first) {
    std::vector<int> corners;
    for (int r = 0; r + 1 < rows; ++r)
      for (int c = 0; c + 1 < across; ++c) {
        const int a = first + r * across + c;
        corners.insert(corners.end(), {a, a + 1, a + 1 + across, a, a + 1 + across, a + across});
      }
    return Eigen::Map<Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>>(
        corners.data(), static_cast<Eigen::Index>(corners.size() / 3), 3);
  }

  static MatrixX3d at(double angle) {
    MatrixX3d V(2 * rows * across, 3);
    for (int leaf = 0; leaf < 2; ++leaf)
      for (int r = 0; r < rows; ++r)
        for (int c = 0; c < across; ++c)
          V.row((leaf * rows + r) * across + c) =
              spacing * Eigen::RowVector3d(c * std::cos(leaf * angle), r, c * std::sin(leaf * angle));
    return V;
  }

  /// Of the second leaf in the first.
  double penetration(double angle) const {
    const MatrixX3d rest = at(0.3);
    ContactScene contacts(rest.rows());
    const int obstacle = contacts.add_patch(rest, leaf), own = contacts.add_patch(rest, other_leaf);
    contacts.add_pair(VectorXi::LinSpaced(rows * across, rows * across, 2 * rows * across - 1), obstacle, own, rest);
    return contacts.penetration(at(angle));
  }
};

TEST(Contact, LeavesThatCrossAtTheirHingePenetrateAndThoseThatOpenAllTheWayDoNot) {
  const Hinge hinge;
  EXPECT_EQ(hinge.penetration(0.1), 0);
  EXPECT_NEAR(hinge.penetration(-0.3), (Hinge::across - 1) * Hinge::spacing * std::sin(0.3), 1e-12);
  for (const double degrees : {90, 180, 260, 280, 300})
    EXPECT_EQ(hinge.penetration(degrees * 3.14159265358979323846 / 180), 0) << degrees;
}

TEST(Contact, AVertexThatFacesAsItsObstaclePenetratesUnlessItIsDeep) {
  // Two sheets that face up, one over the middle of the other.
  MatrixX3d rest(8, 3);
  rest << 0, 0, 0, 20, 0, 0, 20, 20, 0, 0, 20, 0, 8, 8, 1, 12, 8, 1, 12, 12, 1, 8, 12, 1;
  rest *= 1e-3;
  MatrixX3i below(2, 3), above(2, 3);
  below << 0, 1, 2, 0, 2, 3;
  above << 4, 5, 6, 4, 6, 7;
  ContactScene contacts(rest.rows());
  const int obstacle = contacts.add_patch(rest, below), own = contacts.add_patch(rest, above);
  contacts.add_pair(VectorXi::LinSpaced(4, 4, 7), obstacle, own, rest);
  const auto penetration = [&](double height) {
    MatrixX3d x = rest;
    x.bottomRows(4).col(2).setConstant(height);
    return contacts.penetration(x);
  };
  EXPECT_EQ(penetration(1e-4), 0);
  EXPECT_NEAR(penetration(-2e-4), 2e-4, 1e-12) << "pressed in while the skins fold";
  EXPECT_EQ(penetration(-1e-3), 0) << "on the other side";
}

TEST(Contact, MultipliersSolveTheComplementarityProblem) {
  Random random(7);
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::Index n = 1 + trial % 40;
    Eigen::MatrixXd B(n, n);
    Eigen::VectorXd q(n);
    for (Eigen::Index i = 0; i < B.size(); ++i) B.data()[i] = random.normal();
    for (Eigen::Index i = 0; i < n; ++i) q[i] = random.normal();
    const Eigen::MatrixXd M = B * B.transpose() + 1e-3 * Eigen::MatrixXd::Identity(n, n);
    std::vector<char> active;
    const Eigen::VectorXd lambda = solve_complementarity(M, q, active);
    ASSERT_EQ(lambda.size(), n);
    const Eigen::VectorXd gap = M * lambda + q;
    EXPECT_GE(lambda.minCoeff(), 0.0);
    EXPECT_GT(gap.minCoeff(), -1e-9 * q.cwiseAbs().maxCoeff());
    EXPECT_LT(std::abs(lambda.dot(gap)), 1e-8 * (1 + lambda.norm()));
  }
}

TEST(Contact, SchurSolutionEqualsTheDirectKktSolution) {
  Random random(8);
  const Eigen::Index n = 30, m = 6;
  Eigen::MatrixXd B(n, n), C(m, n);
  Eigen::VectorXd b(n), d(m);
  for (Eigen::Index i = 0; i < B.size(); ++i) B.data()[i] = random.normal();
  for (Eigen::Index i = 0; i < C.size(); ++i) C.data()[i] = random.normal();
  for (Eigen::Index i = 0; i < n; ++i) b[i] = random.normal();
  const Eigen::MatrixXd A = B * B.transpose() + Eigen::MatrixXd::Identity(n, n);
  const Eigen::LLT<Eigen::MatrixXd> llt(A);
  d = C * llt.solve(b) + Eigen::VectorXd::Constant(m, 0.1);  // all rows push
  std::vector<char> active;
  // Rows C x >= d: x = A^-1 (b + C^T lambda).
  const Eigen::VectorXd lambda = solve_complementarity(C * llt.solve(C.transpose()), C * llt.solve(b) - d, active);
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < m; ++i)
    if (active[static_cast<std::size_t>(i)]) rows.push_back(i);
  ASSERT_FALSE(rows.empty());
  const auto k = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n + k, n + k);
  K.topLeftCorner(n, n) = A;
  K.topRightCorner(n, k) = -C(rows, Eigen::all).transpose();
  K.bottomLeftCorner(k, n) = C(rows, Eigen::all);
  Eigen::VectorXd rhs(n + k);
  rhs << b, d(rows);
  const Eigen::VectorXd direct = K.partialPivLu().solve(rhs);
  const Eigen::VectorXd x = llt.solve(b + C.transpose() * lambda);
  EXPECT_LT((x - direct.head(n)).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_LT((lambda(rows) - direct.tail(k)).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((C(rows, Eigen::all) * x - d(rows)).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(Contact, NonsenseIsRefused) {
  ContactScene contacts(10);
  EXPECT_ANY_THROW(contacts.add_pair(VectorXi::Zero(1), 3, -1, MatrixX3d::Zero(10, 3)));
  EXPECT_ANY_THROW(contacts.add_patch(MatrixX3d::Zero(10, 3), MatrixX3i(0, 3)));
}

}  // namespace
}  // namespace phiz
