// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "face/small_face.h"
#include "phiz/core/error.h"
#include "phiz/face/activation_fit.h"
#include "phiz/face/muscle_simulation.h"
#include "phiz/face/volumetric_blendshapes.h"

namespace phiz {
namespace {

/// The small face with a muscle from corner to corner in each lip.
const FaceModel& lips() {
  static const FaceModel instance = [] {
    HeadTemplate head = testing::small_head();
    for (const bool of_upper : {false, true}) {
      Muscle muscle;
      muscle.name = of_upper ? "upper" : "lower";
      std::vector<int> tets;
      for (int t = 0; t < head.volume.T.rows(); ++t) {
        const double y = head.volume.V(head.volume.T.row(t), 1).mean();
        if (std::abs(y) < 0.009 && (y > 0) == of_upper) tets.push_back(t);
      }
      muscle.tets = Eigen::Map<VectorXi>(tets.data(), static_cast<Eigen::Index>(tets.size()));
      muscle.fraction = VectorXd::Constant(muscle.tets.size(), 0.7);
      muscle.direction = Vector3d::UnitX().transpose().replicate(muscle.tets.size(), 1);
      head.muscles.push_back(muscle);
    }
    return build_volumetric_blendshapes(head);
  }();
  return instance;
}

double distance_to(const VolumetricShape& shape, const MatrixX3d& x) {
  const MatrixX3d away = x - lips().head.volume.V - shape.displacement.cast<double>();
  return std::sqrt(away(lips().head.skin_vertices, Eigen::all).rowwise().squaredNorm().mean());
}

TEST(ActivationFit, ForwardPhysicsComesToTheExpression) {
  const HeadTissue tissue = head_tissue(lips().head);
  std::vector<ActivationShape> shapes = estimate_activations(lips(), tissue);
  for (const std::size_t j : {0U, 1U}) {  // the estimate of the first, by the jaw, is right already
    const VolumetricShape& shape = lips().shapes[j];
    const auto reached = [&] {
      MuscleSimulation simulation(lips(), shapes);
      EXPECT_TRUE(simulation.solve_static(VectorXd::Unit(3, static_cast<Eigen::Index>(j))).converged);
      return distance_to(shape, simulation.positions());
    };
    const double estimated = reached();
    const ActivationFit fit = fit_activation(lips(), tissue, shape, shapes[j]);
    EXPECT_EQ(fit.shape.name, shape.name);
    EXPECT_EQ(fit.shape.jaw, shape.jaw);
    EXPECT_EQ(fit.contractions.size(), 2);
    EXPECT_LT(fit.distance, std::max(1e-6, 0.5 * fit.start));
    shapes[j] = fit.shape;
    const double fitted = reached();
    EXPECT_LT(fitted, std::max(1e-6, 0.6 * estimated)) << shape.name;
  }
}

TEST(ActivationFit, RefusesShapesWithoutDisplacement) {
  const HeadTissue tissue = head_tissue(lips().head);
  VolumetricShape shape = lips().shapes[0];
  shape.displacement.resize(0, 3);
  EXPECT_THROW(fit_activation(lips(), tissue, shape, estimate_activations(lips(), tissue)[0]), Error);
}

}  // namespace
}  // namespace phiz
