// SPDX-License-Identifier: GPL-3.0-or-later
// Inverse physics on a block with two muscles (phace.md 9.1 and 15.3).
#include <gtest/gtest.h>

#include <cmath>

#include "elasticity/tissue_blocks.h"
#include "phiz/core/error.h"
#include "phiz/elasticity/tissue_inverse.h"
#include "phiz/elasticity/tissue_newton.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/topology.h"

namespace phiz {
namespace {

using testing::box;
using testing::pin;
using testing::shaken;
using testing::slide;
using testing::tissue_of;
using testing::vertices_where;

/// 6 x 4 x 3 cells of 10 mm, held at the bottom; the middle layer is muscle, its halves contract along x and y.
struct TwoMuscleBlock {
  TissueBody body = tissue_of(box(Vector3d::Zero(), Vector3d(0.06, 0.04, 0.03), 6, 4, 3));
  std::vector<MuscleFibres> muscles = std::vector<MuscleFibres>(2);
  VectorXi skin;
  MatrixX3i skin_triangles;
  VectorXd contractions = Eigen::Vector2d(1 / 1.40, 1 / 1.15);
  MatrixX3d truth;

  TwoMuscleBlock() {
    pin(body, [](const Vector3d& p) { return p.z() == 0; });
    skin = vertices_where(body, [](const Vector3d& p) { return p.z() == 0.03; });
    std::vector<Eigen::Vector3i> top;
    const MatrixX3i boundary = boundary_triangles(body.tets);
    for (Eigen::Index f = 0; f < boundary.rows(); ++f)
      if ((body.rest(boundary.row(f), 2).array() == 0.03).all()) top.emplace_back(boundary.row(f));
    skin_triangles.resize(static_cast<Eigen::Index>(top.size()), 3);
    for (std::size_t f = 0; f < top.size(); ++f) skin_triangles.row(static_cast<Eigen::Index>(f)) = top[f];

    body.active = VectorXd::Zero(body.tets.rows());
    std::vector<Matrix3d> stretches(static_cast<std::size_t>(body.tets.rows()), Matrix3d::Identity());
    std::vector<int> tets[2];
    for (int t = 0; t < body.tets.rows(); ++t) {
      const Vector3d centre = body.rest(body.tets.row(t), Eigen::all).colwise().mean();
      if (centre.z() < 0.01 || centre.z() > 0.02) continue;
      const int m = centre.x() < 0.03 ? 0 : 1;
      body.active[t] = 1;
      tets[m].push_back(t);
      stretches[static_cast<std::size_t>(t)] = contracted_stretch(Vector3d::Unit(m), contractions[m]);
    }
    for (int m = 0; m < 2; ++m) {
      MuscleFibres& muscle = muscles[static_cast<std::size_t>(m)];
      muscle.tets = Eigen::Map<VectorXi>(tets[m].data(), static_cast<Eigen::Index>(tets[m].size()));
      muscle.fraction = VectorXd::Ones(muscle.tets.size());
      muscle.direction = Vector3d::Unit(m).transpose().replicate(muscle.tets.size(), 1);
    }
    TissueEnergy energy(body);
    energy.set_activation(stretches);
    truth = body.rest;
    EXPECT_TRUE(solve_static(energy, truth).converged);
  }

  std::vector<ShapeTarget> targets(bool planes) const {
    const MatrixX3d normals = vertex_normals(truth, skin_triangles);
    std::vector<ShapeTarget> out;
    for (const int v : skin)
      out.push_back({v, truth.row(v), planes ? Vector3d(normals.row(v)) : Vector3d(Vector3d::Zero()), 1});
    return out;
  }
  double skin_error(const MatrixX3d& x) const {
    return std::sqrt((x - truth)(skin, Eigen::all).rowwise().squaredNorm().mean());
  }
  double height_error(const MatrixX3d& x) const {
    const MatrixX3d normals = vertex_normals(truth, skin_triangles);
    return std::sqrt(
        (x - truth)(skin, Eigen::all).cwiseProduct(normals(skin, Eigen::all)).rowwise().sum().cwiseAbs2().mean());
  }
};

const TwoMuscleBlock& scene() {
  static const TwoMuscleBlock instance;
  return instance;
}

TEST(TissueEnergy, GradientByActivationAgreesWithDifferences) {
  TissueBody body = scene().body;
  slide(body, 2, 0, [](const Vector3d& p) { return p.z() == 0.03 && p.x() == 0; });
  body.active *= 0.7;
  TissueEnergy energy(body);
  Random random(3);
  std::vector<Matrix3d> stretches(static_cast<std::size_t>(body.tets.rows()));
  for (Matrix3d& S : stretches)
    S = activation_stretch(neutral_activation() + 0.2 * Vector6d::NullaryExpr([&](auto) { return random.normal(); }));
  MatrixX3d x = shaken(body.rest, 5e-3, 4);  // with inverted tets
  put_on_slides(body, x);
  const FreeMotion motion(body, x);
  const VectorXi tets = scene().muscles[0].tets;
  energy.set_activation(stretches);
  const MatrixXd derivative = energy.gradient_by_activation(x, motion, tets);
  const double scale = derivative.cwiseAbs().maxCoeff();
  for (const Eigen::Index column : {0, 7, 14, 100, 200, 431}) {
    constexpr double h = 1e-6;
    VectorXd both[2];
    for (const int sign : {0, 1}) {
      std::vector<Matrix3d> moved = stretches;
      Matrix3d& S = moved[static_cast<std::size_t>(tets[column / 6])];
      S += (sign == 0 ? h : -h) * activation_stretch(Vector6d::Unit(column % 6));
      energy.set_activation(moved);
      both[sign] = motion.reduced(energy.gradient(x));
    }
    EXPECT_LT((derivative.col(column) - (both[0] - both[1]) / (2 * h)).cwiseAbs().maxCoeff(), 1e-6 * scale) << column;
  }
}

TEST(TissueInverse, FindsWhichMusclesMadeAShape) {
  const double moved = scene().skin_error(scene().body.rest);
  InverseOptions options;
  options.exact = true;
  const InverseResult result =
      find_activations(scene().body, scene().targets(false), scene().muscles, scene().body.rest, {}, options);
  EXPECT_TRUE(result.converged);
  EXPECT_LT(scene().skin_error(result.x), 1e-5 * moved);
  EXPECT_LT(result.gradient, 1e-2);
  EXPECT_NEAR(result.contractions[0], 1 / 1.40, 2e-3);
  EXPECT_NEAR(result.contractions[1], 1 / 1.15, 2e-3);
  for (std::size_t k = 1; k < result.objectives.size(); ++k) EXPECT_LT(result.objectives[k], result.objectives[k - 1]);
  // What is returned is an equilibrium under what is returned.
  TissueEnergy energy(scene().body);
  energy.set_activation(result.stretches);
  MatrixX3d x = scene().body.rest;
  EXPECT_TRUE(solve_static(energy, x).converged);
  EXPECT_LT((x - result.x).rowwise().norm().maxCoeff(), 1e-7);
}

TEST(TissueInverse, TheRealTimeEngineServes) {
  const InverseResult result =
      find_activations(scene().body, scene().targets(false), scene().muscles, scene().body.rest);
  EXPECT_TRUE(result.converged);
  EXPECT_LT(scene().skin_error(result.x), 1e-3 * scene().skin_error(scene().body.rest));
  TissueEnergy energy(scene().body);
  energy.set_activation(result.stretches);
  MatrixX3d x = result.x;
  EXPECT_TRUE(solve_static(energy, x).converged);
  EXPECT_LT((x - result.x).rowwise().norm().maxCoeff(), 2e-6);
}

TEST(TissueInverse, FreedomBeyondFibresAbsorbsWrongOnes) {
  std::vector<MuscleFibres> turned = scene().muscles;
  const Matrix3d turn = Eigen::AngleAxisd(0.5, Vector3d::UnitZ()).toRotationMatrix();
  for (MuscleFibres& muscle : turned) muscle.direction = muscle.direction * turn.transpose();
  const InverseResult result = find_activations(scene().body, scene().targets(false), turned, scene().body.rest);
  EXPECT_TRUE(result.converged);
  EXPECT_LT(scene().skin_error(result.x), 5e-3 * scene().skin_error(scene().body.rest));
}

TEST(TissueInverse, SparsityQuietsTheMuscleThatIsNotNeeded) {
  // Only the first muscle works.
  std::vector<Matrix3d> stretches(static_cast<std::size_t>(scene().body.tets.rows()), Matrix3d::Identity());
  for (const int t : scene().muscles[0].tets)
    stretches[static_cast<std::size_t>(t)] = contracted_stretch(Vector3d::UnitX(), 0.8);
  TissueEnergy energy(scene().body);
  energy.set_activation(stretches);
  MatrixX3d truth = scene().body.rest;
  ASSERT_TRUE(solve_static(energy, truth).converged);
  std::vector<ShapeTarget> targets;
  for (const int v : scene().skin)
    targets.push_back({v, truth.row(v) + 2e-4 * Vector3d::Unit(v % 3).transpose(), Vector3d::Zero(), 1});
  const auto second_moves = [&](const MusclePriorWeights& weights) {
    InverseOptions options;
    options.prior = weights;
    const InverseResult result =
        find_activations(scene().body, targets, scene().muscles, scene().body.rest, {}, options);
    EXPECT_TRUE(result.converged);
    double sum = 0;
    for (const int t : scene().muscles[1].tets)
      sum += (result.stretches[static_cast<std::size_t>(t)] - Matrix3d::Identity()).squaredNorm();
    return std::sqrt(sum / static_cast<double>(scene().muscles[1].tets.size()));
  };
  const double loose = second_moves({1e-2, 0, 1e-8}), sparse = second_moves({1e-2, 0.3, 1e-8});
  EXPECT_GT(loose, 5e-3);
  EXPECT_LT(sparse, 0.2 * loose);
}

TEST(TissueInverse, ErrorGrowsSmoothlyWithNoise) {
  double before = 0;
  for (const double noise : {0.0, 1e-5, 3e-5, 1e-4, 2e-4, 4e-4}) {
    std::vector<ShapeTarget> targets = scene().targets(false);
    Random random(5);  // the same noise, scaled
    for (ShapeTarget& target : targets)
      for (int k = 0; k < 3; ++k) target.place[k] += noise * random.normal();
    InverseOptions options;
    options.prior.direction = 1;
    const InverseResult result =
        find_activations(scene().body, targets, scene().muscles, scene().body.rest, {}, options);
    EXPECT_TRUE(result.converged) << noise;
    const double error = scene().skin_error(result.x);
    EXPECT_LT(error, 1e-5 + 2 * noise) << noise;
    EXPECT_GT(error, 0.9 * before) << noise;
    before = error;
  }
}

TEST(TissueInverse, PlanesForgiveTargetsThatSlippedAlongTheSurface) {
  std::vector<ShapeTarget> targets = scene().targets(true);
  for (ShapeTarget& target : targets) {
    // Slip of 1 mm, another way at every vertex.
    const double angle = 1.7 * target.vertex;
    const Vector3d tangent = target.normal.unitOrthogonal(), across = target.normal.cross(tangent);
    target.place += 1e-3 * (std::cos(angle) * tangent + std::sin(angle) * across);
  }
  InverseOptions points, planes;
  points.point_weight = 1;
  points.plane_weight = 0;
  planes.point_weight = 0.01;
  planes.plane_weight = 1;
  points.prior.direction = planes.prior.direction = 3;
  const InverseResult by_points =
                          find_activations(scene().body, targets, scene().muscles, scene().body.rest, {}, points),
                      by_planes =
                          find_activations(scene().body, targets, scene().muscles, scene().body.rest, {}, planes);
  EXPECT_TRUE(by_points.converged && by_planes.converged);
  EXPECT_LT(scene().height_error(by_planes.x), 0.5 * scene().height_error(by_points.x));
  EXPECT_LT(scene().skin_error(by_planes.x), scene().skin_error(by_points.x));
}

TEST(TissueInverse, RefusesNonsense) {
  const TwoMuscleBlock& s = scene();
  std::vector<ShapeTarget> targets = s.targets(true);
  EXPECT_THROW(find_activations(s.body, {}, s.muscles, s.body.rest), Error);
  EXPECT_THROW(find_activations(s.body, targets, s.muscles, MatrixX3d(3, 3)), Error);
  EXPECT_THROW(find_activations(s.body, targets, s.muscles, s.body.rest, {Matrix3d::Identity()}), Error);
  InverseOptions options;
  options.prior.least_stretch = 2;
  EXPECT_THROW(find_activations(s.body, targets, s.muscles, s.body.rest, {}, options), Error);
  targets[3].vertex = 100000;
  EXPECT_THROW(find_activations(s.body, targets, s.muscles, s.body.rest), Error);
  targets = s.targets(true);
  targets[3].place[1] = std::nan("");
  EXPECT_THROW(find_activations(s.body, targets, s.muscles, s.body.rest), Error);
  TissueBody passive = s.body;
  passive.active.setZero();
  EXPECT_THROW(find_activations(passive, s.targets(true), s.muscles, s.body.rest), Error);
}

}  // namespace
}  // namespace phiz
