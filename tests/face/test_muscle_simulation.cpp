// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "face/simulated_faces.h"
#include "geometry/shapes.h"
#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/face/muscle_simulation.h"
#include "phiz/geometry/spatial_query.h"

namespace phiz {
namespace {

using namespace phiz::testing;

const Vector3d cheek(0.046, -0.025, 0.058), cheek_normal = Vector3d(0.8, -0.05, 0.6).normalized();

MuscleSimulation simulation_of(const FaceModel& model, const MuscleOptions& options = {}) {
  return {model, estimate_activations(model, head_tissue(model.head, options.tissue)), options};
}

MuscleOptions moving(double time_step, double damping) {
  MuscleOptions options;
  options.dynamic = true;
  options.time_step = time_step;
  options.damping = damping;
  return options;
}

/// Vertices of the skin within a distance of a point at rest.
std::vector<int> skin_near(const HeadTemplate& head, const Vector3d& point, double distance) {
  std::vector<int> near;
  for (const int v : head.skin_vertices)
    if ((head.volume.V.row(v).transpose() - point).norm() < distance) near.push_back(v);
  return near;
}

/// Mean movement of some vertices, metres.
Vector3d mean_move(const std::vector<int>& vertices, const MatrixX3d& from, const MatrixX3d& to) {
  Vector3d sum = Vector3d::Zero();
  for (const int v : vertices) sum += (to.row(v) - from.row(v)).transpose();
  return sum / static_cast<double>(vertices.size());
}

/// How deep the deepest vertex of the skin is inside of a surface, metres.
double deepest_inside(const HeadTemplate& head, const MatrixX3d& x, const TriangleMesh& mesh,
                      const Eigen::Isometry3d& place) {
  const SurfaceQuery query(mesh);
  const Eigen::Isometry3d back = place.inverse();
  double depth = 0;
  for (const int v : head.skin_vertices) depth = std::max(depth, -query.signed_distance(back * x.row(v).transpose()));
  return depth;
}

/// A closed box with outward triangles and a grid of `cells` along each edge of a face.
TriangleMesh box_surface(const Vector3d& low, const Vector3d& high, int cells) {
  const TetMesh solid = box(low, high, cells, cells, cells);
  return {solid.V, boundary_triangles(solid.T), {}, {}};
}

TEST(MuscleSimulation, OfNeutralWeightsIsTheRestShape) {
  MuscleSimulation simulation = simulation_of(preview_model());
  simulation.solve_static(weights_of(preview_model(), {}));
  EXPECT_LT(largest_distance(simulation.positions(), preview_model().head.volume.V), 1e-7);
  EXPECT_EQ(simulation.penetration(), 0);
}

TEST(MuscleSimulation, StaticsIsTheLimitOfDampedDynamics) {
  const VectorXd weights = weights_of(small_model(), {{"mouthPucker", 0.7}, {"mouthPressLeft", 0.4}});
  MuscleOptions options;
  options.solve.step_tolerance = 2e-6;
  MuscleSimulation still = simulation_of(small_model(), options);
  EXPECT_TRUE(still.solve_static(weights).converged);
  MuscleOptions dynamic = moving(1.0 / 60, 20);
  dynamic.solve.step_tolerance = 2e-6;
  MuscleSimulation damped = simulation_of(small_model(), dynamic);
  damped.rest(Eigen::Isometry3d::Identity());
  for (int f = 0; f < 3; ++f) damped.step(1.0 / 60, weights, Eigen::Isometry3d::Identity());
  EXPECT_GT(largest_distance(damped.positions(), small_model().head.volume.V), 1e-3);
  for (int f = 0; f < 90; ++f) damped.step(1.0 / 60, weights, Eigen::Isometry3d::Identity());
  EXPECT_LT(largest_distance(damped.positions(), still.positions()), 2e-5);
  EXPECT_LT(damped.velocity().rowwise().norm().maxCoeff(), 1e-3);
}

TEST(MuscleSimulation, AStaticFrameAndItsStartOfDynamicsAreTheSame) {
  const VectorXd weights = weights_of(small_model(), {{"mouthPucker", 0.5}});
  MuscleSimulation still = simulation_of(small_model()), moves = simulation_of(small_model(), moving(1.0 / 60, 0));
  still.solve_static(weights);
  Eigen::Isometry3d head = place_at({0.1, 0.2, 0.3});
  head.rotate(Eigen::AngleAxisd(0.5, Vector3d::UnitY()));
  moves.settle(weights, head);
  EXPECT_LT(largest_distance(still.positions(), moves.positions()), 1e-7);
  moves.step(1.0 / 60, weights, head);
  EXPECT_LT(largest_distance(still.positions(), moves.positions()), 2e-5);
  EXPECT_THROW(moves.solve_static(weights), Error);
  EXPECT_THROW(still.step(1.0 / 60, weights, head), Error);
}

TEST(MuscleSimulation, OfATurningHeadLetsCheeksLagAndSettle) {
  const FaceModel& model = preview_model();
  const auto vertices = skin_near(model.head, cheek, 0.015);
  ASSERT_GT(vertices.size(), 5U);
  const VectorXd weights = weights_of(model, {{"mouthPucker", 0.2}});
  MuscleSimulation simulation = simulation_of(model, moving(1.0 / 120, 5));
  simulation.settle(weights, Eigen::Isometry3d::Identity());
  const MatrixX3d still = simulation.positions();
  Eigen::Isometry3d head = Eigen::Isometry3d::Identity();
  double ahead = 0, behind = 0;  // along the way that a cheek goes when the head turns to the left, metres
  constexpr int turning = 12;
  for (int f = 1; f <= 120; ++f) {
    const double angle = 0.3 * (1 - std::cos(M_PI * std::min(f, turning) / turning));  // at rest before and after
    head.linear() = Eigen::AngleAxisd(angle, Vector3d::UnitY()).toRotationMatrix();
    simulation.step(1.0 / 120, weights, head);
    const Vector3d move = mean_move(vertices, still, simulation.positions());
    const double along = move.dot(Vector3d::UnitY().cross(cheek).normalized());
    if (f <= turning / 2) behind = std::max(behind, -along);
    if (f > turning / 2) ahead = std::max(ahead, along);
  }
  EXPECT_GT(behind, 3e-4);
  EXPECT_GT(ahead, 3e-4);
  EXPECT_LT(mean_move(vertices, still, simulation.positions()).norm(), 0.1 * behind);
}

TEST(MuscleSimulation, WindFromTheRightPushesSkinToTheLeft) {
  const FaceModel& model = preview_model();
  const auto vertices = skin_near(model.head, Vector3d(-cheek.x(), cheek.y(), cheek.z()), 0.015);
  const VectorXd weights = weights_of(model, {{"mouthPucker", 0.2}});
  MuscleOptions options;
  MuscleSimulation calm = simulation_of(model, options);
  calm.solve_static(weights);
  const MatrixX3d still = calm.positions();
  calm.set_wind(Vector3d::Zero());
  calm.solve_static(weights);
  EXPECT_LT(largest_distance(still, calm.positions()), 5e-5);
  double before = 0;
  for (const double speed : {15.0, 30.0}) {
    calm.set_wind({speed, 0, 0});
    calm.solve_static(weights);
    const Vector3d move = mean_move(vertices, still, calm.positions());
    EXPECT_GT(move.x(), std::max(2e-5, 2.5 * before));  // with the square of its speed
    before = move.x();
  }
}

TEST(MuscleSimulation, OfAPunchLetsNothingIntoTheBall) {
  const FaceModel& model = preview_model();
  const TriangleMesh ball = test::sphere(Vector3d::Zero(), 0.04, 3);
  MuscleSimulation simulation = simulation_of(model, moving(1.0 / 240, 0));
  const VectorXd weights = weights_of(model, {{"mouthSmileLeft", 0.1}});
  simulation.settle(weights, Eigen::Isometry3d::Identity());
  const MatrixX3d still = simulation.positions();
  const auto at = [&](double distance) { return place_at(cheek + (0.04 + distance) * cheek_normal); };
  const int object = simulation.add_object(ball, at(0.05));
  const auto hit = skin_near(model.head, cheek, 0.012);
  double dent = 0;
  for (int f = 1; f <= 24; ++f) {
    // 5 m/s inward, a stop 12 mm deep, and back at 2 m/s.
    const double t = f / 240.0, distance = t < 0.025 ? std::max(0.05 - 5 * t, -0.012) : -0.012 + 2 * (t - 0.025);
    simulation.move_object(object, at(distance));
    simulation.step(1.0 / 240, weights, Eigen::Isometry3d::Identity());
    EXPECT_LT(deepest_inside(model.head, simulation.positions(), ball, at(distance)), 1e-4) << "frame " << f;
    for (Eigen::Index v = 0; v < still.rows(); ++v)
      if (simulation.tissue().body.pinned[static_cast<std::size_t>(v)]) {
        ASSERT_EQ(simulation.positions().row(v), still.row(v)) << "vertex " << v;
      }
    dent = std::max(dent, -mean_move(hit, still, simulation.positions()).dot(cheek_normal));
  }
  EXPECT_GT(dent, 5e-3);
}

TEST(MuscleSimulation, CatchesWhatWouldBePastTheSkinInOneFrame) {
  const FaceModel& model = preview_model();
  const TriangleMesh ball = test::sphere(Vector3d::Zero(), 0.02, 3);
  MuscleSimulation simulation = simulation_of(model, moving(1.0 / 60, 0));
  const VectorXd weights = weights_of(model, {{"mouthSmileLeft", 0.1}});
  simulation.settle(weights, Eigen::Isometry3d::Identity());
  const MatrixX3d still = simulation.positions();
  const int object = simulation.add_object(ball, place_at(cheek + 0.3 * cheek_normal));
  const Eigen::Isometry3d end = place_at(cheek + 0.01 * cheek_normal);  // its far side would be 10 mm below the skin
  simulation.move_object(object, end);
  simulation.step(1.0 / 60, weights, Eigen::Isometry3d::Identity());
  EXPECT_LT(deepest_inside(model.head, simulation.positions(), ball, end), 1e-4);
  EXPECT_GT(largest_distance(simulation.positions(), still), 5e-3);
  // The same when the ball is at rest and the head comes to it.
  MuscleSimulation other = simulation_of(model, moving(1.0 / 60, 0));
  other.settle(weights, place_at(-0.29 * cheek_normal));
  other.add_object(ball, end);
  other.step(1.0 / 60, weights, Eigen::Isometry3d::Identity());
  EXPECT_LT(deepest_inside(model.head, other.positions(), ball, end), 1e-4);
}

TEST(MuscleSimulation, AHeadsetPushesOnlyAndStraightAndKeepsTheVolume) {
  const FaceModel& model = preview_model();
  const Vector3d low(-0.07, 0.022, 0), high(0.07, 0.085, 0.05);
  const TriangleMesh headset = box_surface(low, high, 12);
  MuscleSimulation simulation = simulation_of(model);
  simulation.solve_static(weights_of(model, {{"jawOpen", 0.02}}));
  const int object = simulation.add_object(headset, place_at({0, 0, 0.1}));
  const SurfaceQuery surface(headset);
  double pushed = 0;
  for (int f = 0; f <= 12; ++f) {
    const double speech = 0.5 - 0.5 * std::cos(0.8 * f);
    const Eigen::Isometry3d place = place_at({0, 0, std::max(0.1 - 0.01 * f, 0.0725)});
    simulation.move_object(object, place);
    const SolveStatistics statistics =
        simulation.solve_static(weights_of(model, {{"jawOpen", 0.02 + 0.4 * speech}, {"mouthPucker", 0.5 * speech}}));
    EXPECT_LT(deepest_inside(model.head, simulation.positions(), headset, place), 1e-4) << "frame " << f;
    EXPECT_LT(std::abs(statistics.volume_change), 0.01);
    const MatrixX3d force = simulation.contact_forces();
    for (const int v : model.head.skin_vertices) {
      const Vector3d p = place.inverse() * simulation.positions().row(v).transpose();
      const SurfacePoint nearest = surface.closest_point(p);
      if (std::sqrt(nearest.squared_distance) > 1e-4 || force.row(v).norm() < 1e-9) continue;
      // Out of the headset, along the normal of one of its faces; across an edge, of two.
      Vector3d outward = Vector3d::Zero();
      for (int k = 0; k < 3; ++k) {
        if (std::abs(nearest.position[k] - low[k]) < 2e-4) outward[k] = -1;
        if (std::abs(nearest.position[k] - high[k]) < 2e-4) outward[k] = 1;
      }
      const Vector3d push = force.row(v);
      pushed = std::max(pushed, push.norm());
      EXPECT_GT(push.dot(outward), 0);
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(outward[k] == 0 ? push[k] : 0, 0, 1e-6 * push.norm());
    }
  }
  EXPECT_GT(pushed, 1e-3);
}

TEST(MuscleSimulation, OfAParalysedSideMovesThatSideMuchLess) {
  const FaceModel& model = preview_model();
  const auto right = skin_near(model.head, Vector3d(-cheek.x(), cheek.y(), cheek.z()), 0.02),
             left = skin_near(model.head, cheek, 0.02);
  const VectorXd smile = weights_of(model, {{"mouthSmileLeft", 1}, {"mouthSmileRight", 1}});
  const MatrixX3d& rest = model.head.volume.V;
  MuscleSimulation simulation = simulation_of(model);
  simulation.solve_static(0.05 * smile);
  simulation.solve_static(smile);
  const Vector3d left_move = mean_move(left, rest, simulation.positions()),
                 right_move = mean_move(right, rest, simulation.positions());
  EXPECT_GT(left_move.norm(), 2e-3);
  EXPECT_LT((left_move - Vector3d(-right_move.x(), right_move.y(), right_move.z())).norm(), 0.03 * left_move.norm());
  simulation.set_tet_innervation(paralysis(model.head, simulation.tissue(), {"left"}));
  simulation.solve_static(smile);
  EXPECT_LT(mean_move(left, rest, simulation.positions()).norm(), 0.25 * left_move.norm());
  EXPECT_GT(mean_move(right, rest, simulation.positions()).norm(), 0.8 * right_move.norm());
  simulation.set_tet_innervation({});
  simulation.solve_static(smile);
  EXPECT_LT((mean_move(left, rest, simulation.positions()) - left_move).norm(), 1e-4);
}

TEST(MuscleSimulation, IsTheSameToTheBitWithOneThreadAndTwo) {
  const FaceModel& model = preview_model();
  MatrixX3d first;
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    MuscleOptions options = moving(1.0 / 60, 2);
    options.air.wind = {0, 0, -10};
    MuscleSimulation simulation = simulation_of(model, options);
    simulation.settle(weights_of(model, {{"jawOpen", 0.1}}), Eigen::Isometry3d::Identity());
    for (int f = 1; f <= 6; ++f)
      simulation.step(1.0 / 60, weights_of(model, {{"jawOpen", 0.1 + 0.05 * f}, {"mouthPucker", 0.1 * f}}),
                      place_at({0, 0.002 * f * f, 0}));
    if (threads == 1) first = simulation.positions();
    EXPECT_TRUE(first == simulation.positions()) << largest_distance(first, simulation.positions());
  }
}

TEST(Paralysis, IsOfMuscleNamesPairsAndSides) {
  const FaceModel& model = preview_model();
  const HeadTissue tissue = head_tissue(model.head);
  const VectorXd pair = paralysis(model.head, tissue, {"zygomaticusMajor"}),
                 one = paralysis(model.head, tissue, {"zygomaticusMajorLeft"}),
                 side = paralysis(model.head, tissue, {"left"}), all = paralysis(model.head, tissue, {"left", "right"});
  EXPECT_TRUE((pair.array() <= one.array()).all());
  EXPECT_LT(pair.sum(), one.sum());
  EXPECT_LT(all.maxCoeff(), 1e-12);
  for (Eigen::Index t = 0; t < side.size(); ++t) {
    const auto x = model.head.volume.V(model.head.volume.T.row(tissue.soft[t]), 0);
    if (x.minCoeff() > 1e-9) {
      EXPECT_EQ(side[t], 0);
    } else if (x.maxCoeff() < -1e-9) {
      EXPECT_EQ(side[t], 1);
    }
  }
  EXPECT_THROW(paralysis(model.head, tissue, {"zygomaticusMinr"}), Error);
}

}  // namespace
}  // namespace phiz
