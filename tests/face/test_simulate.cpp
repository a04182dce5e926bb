// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "face/simulated_faces.h"
#include "geometry/shapes.h"
#include "phiz/core/error.h"
#include "phiz/face/animate.h"
#include "phiz/face/simulate.h"
#include "phiz/geometry/spatial_query.h"

namespace phiz {
namespace {

using namespace phiz::testing;

TEST(HeldExpression, ComesFromNeutralAndStays) {
  const Performance one = held_expression({{"jawOpen", 0.5}}, 0, 60);
  EXPECT_EQ(one.time.size(), 1);
  EXPECT_EQ(one.weights(0, 0), 0.5);
  const Performance ramp = held_expression({{"jawOpen", 0.5}, {"mouthPucker", 1}}, 1, 10, 0.5);
  ASSERT_EQ(ramp.time.size(), 10);
  EXPECT_EQ(ramp.weights(0, 1), 0);
  EXPECT_NEAR(ramp.weights(1, 1), 0.2, 1e-12);
  EXPECT_EQ(ramp.weights(9, 0), 0.5);
  EXPECT_THROW(held_expression({}, -1, 60), Error);
  EXPECT_THROW(held_expression({}, 1, 0), Error);
}

TEST(RigidPath, GoesStraightBetweenItsPlacesAndRestsOutside) {
  RigidPath path{{1, 3}, {place_at({0, 0, 0}), place_at({2, 4, 6})}};
  EXPECT_EQ(path.at(0).translation(), Vector3d(0, 0, 0));
  EXPECT_EQ(path.at(2).translation(), Vector3d(1, 2, 3));
  EXPECT_EQ(path.at(9).translation(), Vector3d(2, 4, 6));
  EXPECT_NO_THROW(validate(path, "path"));
  path.time[1] = 1;
  EXPECT_THROW(validate(path, "path"), Error);
  EXPECT_THROW(validate(RigidPath{}, "path"), Error);
  EXPECT_THROW(validate(resting_at(place_at({0, 0, std::nan("")})), "path"), Error);
}

TEST(Simulate, PlaysAPerformanceOnTheSameTermsAsAnimate) {
  const Performance performance = small_performance(6);
  SimulateOptions options;
  options.first_frame = 1;
  options.end_frame = 5;
  const Take take = simulate(small_model(), performance, options);
  AnimateOptions same;
  same.first_frame = 1;
  same.end_frame = 5;
  const Take other = animate(small_model(), performance, same);
  ASSERT_EQ(take.frames.size(), 4U);
  EXPECT_EQ(take.frames_planned, 4);
  for (std::size_t f = 0; f < 4; ++f) {
    EXPECT_TRUE(take.frames[f].statistics.converged);
    EXPECT_EQ(take.frames[f].time, other.frames[f].time);
    EXPECT_EQ(take.frames[f].part_weights, other.frames[f].part_weights);
    EXPECT_TRUE(take.frames[f].head.isApprox(other.frames[f].head));
    EXPECT_EQ(take.frames[f].jaw, other.frames[f].jaw);
    EXPECT_LE(take.frames[f].statistics.penetration, 1e-4);
  }
}

TEST(Simulate, StartsDynamicsAtRest) {
  SimulateOptions options;
  options.muscles.dynamic = true;
  options.head_path = resting_at(place_at({1, 0, 0}));
  const Take take = simulate(small_model(), held_expression({{"mouthPucker", 0.6}}, 0.1, 60), options);
  options.muscles.dynamic = false;
  const Take still = simulate(small_model(), held_expression({{"mouthPucker", 0.6}}, 0, 60), options);
  ASSERT_EQ(take.frames.size(), 6U);
  for (const TakeFrame& frame : take.frames) {
    EXPECT_LT((frame.volume - still.frames[0].volume).rowwise().norm().maxCoeff(), 1e-4);
    EXPECT_EQ(frame.head.translation(), Vector3d(1, 0, 0));
    EXPECT_LT(frame.velocity.rowwise().norm().maxCoeff(), 5e-3);
  }
}

TEST(Simulate, AnObjectThatTheHeadCarriesActsInItsFrame) {
  SimulateOptions options;
  options.head_path = RigidPath{{0, 1}, {place_at({0, 0, 0}), place_at({0.5, 0, 0})}};
  SimulateObject object;
  object.mesh = test::sphere(Vector3d::Zero(), 0.01, 2);
  // Comes from the front before the first frame; the lips end at z = 68 mm.
  object.path = RigidPath{{-0.5, 0}, {place_at({0, -0.006, 0.1}), place_at({0, -0.006, 0.076})}};
  object.on_head = true;
  options.objects.push_back(object);
  const Take take = simulate(small_model(), held_expression({{"mouthPucker", 0.1}}, 0.1, 30), options);
  for (const TakeFrame& frame : take.frames) {
    EXPECT_GT(frame.statistics.contacts, 0);
    EXPECT_LT((frame.volume - take.frames[0].volume).rowwise().norm().maxCoeff(), 1e-4);
    const MatrixX3d seen = frame.volume.cast<double>().rowwise() - Eigen::RowVector3d(0, -0.006, 0.076);
    EXPECT_GT(signed_distances(object.mesh, seen).minCoeff(), -1e-4);
  }
}

TEST(Simulate, RefusesWhatCannotBeSimulated) {
  const Performance performance = held_expression({{"mouthPucker", 0.1}}, 0, 30);
  SimulateOptions options;
  SimulateObject object;
  object.mesh = test::sphere(Vector3d(0, -0.006, 0.076), 0.01, 2);
  object.path = resting_at(Eigen::Isometry3d::Identity());
  options.objects.push_back(object);
  EXPECT_THROW(simulate(small_model(), performance, options), Error);  // it starts in the lips
  options.objects[0].mesh.F.conservativeResize(object.mesh.F.rows() - 1, 3);
  EXPECT_THROW(simulate(small_model(), performance, options), Error);  // a hole
  options.objects.clear();
  options.gusts.period = 0;
  EXPECT_THROW(simulate(small_model(), performance, options), Error);
  options.gusts = {};
  options.first_frame = 1;
  EXPECT_THROW(simulate(small_model(), performance, options), Error);
  options.first_frame = 0;
  options.paralysed = {"tongue"};
  EXPECT_THROW(simulate(small_model(), performance, options), Error);
}

}  // namespace
}  // namespace phiz
