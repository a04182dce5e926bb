// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "face/small_face.h"
#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/face/simulation.h"
#include "phiz/face/volumetric_blendshapes.h"

namespace phiz {
namespace {

using testing::small_weights;

const FaceModel& plain_model() {
  static const FaceModel instance = build_volumetric_blendshapes(testing::small_head());
  return instance;
}

SimulationOptions exact() {
  SimulationOptions options;
  options.solve.max_iterations = 300;
  options.solve.step_tolerance = 1e-8;
  return options;
}

TEST(VolumetricBlendshapes, SkinOfAShapeIsTheSculptedSkinAndItsVolumeIsKept) {
  const HeadTemplate head = testing::small_head();
  BlendshapeOptions options;
  options.volume = 1000;
  options.max_iterations = 3000;
  int reported = 0;
  options.report = [&](const std::string& name, const SolveStatistics& statistics) {
    ++reported;
    if (name == "jawOpen") {
      EXPECT_LT(std::abs(statistics.volume_change), 0.01);
    }
  };
  const FaceModel face = build_volumetric_blendshapes(head, options);
  EXPECT_EQ(reported, 3);
  for (std::size_t m = 0; m < face.shapes.size(); ++m) {
    const MatrixX3d skin = face.shapes[m].displacement.cast<double>()(head.skin_vertices, Eigen::all);
    EXPECT_LT((skin - head.expressions[m].displacement).rowwise().norm().maxCoeff(), 5e-4) << face.shapes[m].name;
  }
}

TEST(Simulation, NoWeightsIsTheRestShape) {
  Simulation simulation(plain_model(), exact());
  simulation.solve_static(small_weights(0, 0, 0));
  EXPECT_LT((simulation.positions() - plain_model().head.volume.V).cwiseAbs().maxCoeff(), 1e-7);
}

TEST(Simulation, OneShapeWithoutContactIsThatShape) {
  SimulationOptions options = exact();
  options.contact = false;
  options.weights.volume = 0;
  Simulation simulation(plain_model(), options);
  simulation.solve_static(small_weights(0, 0.99999, 0));
  const MatrixX3d expected = plain_model().head.volume.V + plain_model().shapes[1].displacement.cast<double>();
  EXPECT_LT((simulation.positions() - expected).rowwise().norm().maxCoeff(), 2e-5);
}

TEST(Simulation, PressedLipsMeetWithoutPenetrationOrLossOfVolume) {
  Simulation simulation(plain_model(), exact());
  const SolveStatistics statistics = simulation.solve_static(small_weights(0, 0, 1));
  EXPECT_GT(statistics.contacts, 5);
  EXPECT_LT(simulation.penetration(), 1e-5);
  EXPECT_LT(std::abs(statistics.volume_change), 0.02);

  SimulationOptions ghost = exact();
  ghost.contact = false;
  Simulation without(plain_model(), ghost);
  without.solve_static(small_weights(0, 0, 1));
  double overlap = -1;
  const auto upper = [](const Vector3d& rest) {
    return rest.y() > 0 && rest.y() < 1.2e-3 && std::abs(rest.x()) < 0.01;
  };
  for (Eigen::Index v = 0; v < without.positions().rows(); ++v)
    if (upper(plain_model().head.volume.V.row(v))) overlap = std::max(overlap, -without.positions()(v, 1));
  EXPECT_GT(overlap, 5e-4);
}

TEST(Simulation, AStiffVolumeKeepsEveryShapeWithinAPercentAndASoftOneDoesNot) {
  double worst[2] = {0, 0};
  for (int k = 0; k < 2; ++k) {
    SimulationOptions options = exact();
    options.solve.max_iterations = 3000;
    options.weights.volume = k == 0 ? 1000 : 0;
    Simulation simulation(plain_model(), options);
    for (const VectorXd& w :
         {small_weights(1, 0, 0), small_weights(0, 1, 0), small_weights(0, 0, 1), small_weights(0, 1, 1)})
      worst[k] = std::max(worst[k], std::abs(simulation.solve_static(w).volume_change));
  }
  EXPECT_LT(worst[0], 0.01);
  EXPECT_GT(worst[1], 2 * worst[0]);
}

TEST(Simulation, AJumpEndsWhereASlowMotionEnds) {
  Simulation jump(plain_model(), exact()), slow(plain_model(), exact());
  jump.solve_static(small_weights(1, 0.5, 0));
  for (int k = 1; k <= 10; ++k) slow.solve_static(small_weights(0.1 * k, 0.05 * k, 0));
  EXPECT_LT((jump.positions() - slow.positions()).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(Simulation, SixIterationsPerFrameStayNearTheConvergedState) {
  SimulationOptions quick;
  quick.solve.max_iterations = 6;
  Simulation a(plain_model(), quick), b(plain_model(), exact());
  for (int f = 0; f <= 30; ++f) {
    const double t = f / 30.0;
    a.solve_static(small_weights(0.5 * t, 0.5 * t, 0));
    b.solve_static(small_weights(0.5 * t, 0.5 * t, 0));
    EXPECT_LT((a.positions() - b.positions()).rowwise().norm().maxCoeff(), 1e-3 * 0.2);
  }
}

TEST(Simulation, ResultHasTheSameBitsForAnyNumberOfThreads) {
  MatrixX3d result[2];
  for (int k = 0; k < 2; ++k) {
    const ThreadLimit limit(k == 0 ? 1 : 4);
    Simulation simulation(plain_model());
    simulation.solve_static(small_weights(0.2, 0.3, 0.8));
    result[k] = simulation.positions();
  }
  EXPECT_EQ((result[0] - result[1]).cwiseAbs().maxCoeff(), 0.0);
}

TEST(Simulation, HeadTurnCarriesTheFleshAlongAndComesToRest) {
  SimulationOptions options = exact();
  options.dynamic = true;
  options.contact = false;
  options.time_step = 1.0 / 30;
  Simulation simulation(plain_model(), options);
  Eigen::Isometry3d turned = Eigen::Isometry3d::Identity();
  turned.linear() = Eigen::AngleAxisd(0.5, Vector3d::UnitY()).toRotationMatrix();
  simulation.step(1.0 / 30, small_weights(0, 0, 0), turned);
  const double lag = (simulation.positions() - plain_model().head.volume.V).rowwise().norm().maxCoeff();
  EXPECT_GT(lag, 1e-4);  // inertia
  for (int k = 0; k < 60; ++k) simulation.step(1.0 / 30, small_weights(0, 0, 0), turned);
  EXPECT_LT((simulation.positions() - plain_model().head.volume.V).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(Simulation, AddedMassLowersTheFrequency) {
  const auto crossing = [&](double density) {
    SimulationOptions options = exact();
    options.dynamic = true;
    options.contact = false;
    options.density = density;
    options.time_step = 1.0 / 2000;
    Simulation simulation(plain_model(), options);
    // Let go from a sideways push, count the steps until the tip passes its rest place.
    SimulationState state = simulation.state();
    Eigen::Index tip = 0;
    (plain_model().head.volume.V.col(1).array().abs()).minCoeff(&tip);
    for (Eigen::Index v = 0; v < state.positions.rows(); ++v)
      if (plain_model().head.carrier[v] == 0)
        state.positions(v, 0) += 1e-3 * (1 - std::abs(plain_model().head.volume.V(v, 1)) / 0.0124);
    simulation.restore(state);
    for (int k = 1; k <= 400; ++k) {
      simulation.step(1.0 / 2000, small_weights(0, 0, 0), Eigen::Isometry3d::Identity());
      if (simulation.positions()(tip, 0) < plain_model().head.volume.V(tip, 0)) return k;
    }
    return 401;
  };
  const int light = crossing(1000), heavy = crossing(4000);
  EXPECT_LT(light, 400);
  EXPECT_NEAR(static_cast<double>(heavy) / light, 2.0, 0.35);
}

TEST(Simulation, NonsenseIsRefused) {
  Simulation simulation(plain_model());
  EXPECT_THROW(simulation.solve_static(VectorXd::Zero(7)), Error);
  EXPECT_THROW(simulation.solve_static(small_weights(0, std::numeric_limits<double>::quiet_NaN(), 0)), Error);
  EXPECT_THROW(simulation.step(0.1, small_weights(0, 0, 0), Eigen::Isometry3d::Identity()), Error);
  SimulationState state = simulation.state();
  state.positions.resize(3, 3);
  EXPECT_THROW(simulation.restore(state), Error);
}

}  // namespace
}  // namespace phiz
