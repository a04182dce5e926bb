// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "face/small_face.h"
#include "phiz/core/error.h"
#include "phiz/face/activation.h"
#include "phiz/face/calibration.h"
#include "phiz/face/flesh.h"
#include "phiz/face/volumetric_blendshapes.h"

namespace phiz {
namespace {

/// The small face, with a muscle that fills this share of both lips.
FaceModel face(double fraction) {
  HeadTemplate head = testing::small_head();
  Muscle muscle;
  muscle.name = "orbicularisOris";
  std::vector<int> tets;
  for (int t = 0; t < head.volume.T.rows(); ++t)
    if (std::abs(head.volume.V.row(head.volume.T(t, 0)).y()) < 0.008) tets.push_back(t);
  muscle.tets = Eigen::Map<VectorXi>(tets.data(), static_cast<Eigen::Index>(tets.size()));
  muscle.fraction = VectorXd::Constant(muscle.tets.size(), fraction);
  head.muscles = {muscle};
  return build_volumetric_blendshapes(head);
}

const FaceModel& model() {
  static const FaceModel instance = face(0.6);
  return instance;
}
const HeadTissue& tissue() {
  static const HeadTissue instance = head_tissue(model().head);
  return instance;
}
std::vector<ActivationShape> shapes() {
  return estimate_activations(model(), tissue());
}
VectorXd weights(double open, double pout, double press) {
  return Vector3d(open, pout, press);
}
double largest_difference(const std::vector<Matrix3d>& a, const std::vector<Matrix3d>& b) {
  double most = 0;
  for (std::size_t t = 0; t < a.size(); ++t) most = std::max(most, (a[t] - b[t]).norm());
  return most;
}

TEST(Activation, OfOneShapeIsItsStretchAndJawPoseWhereThereIsMuscle) {
  const ActivationBlender blender(shapes(), tissue());
  for (int j = 0; j < 3; ++j) {
    const VolumetricShape& shape = model().shapes[static_cast<std::size_t>(j)];
    std::vector<Matrix3d> expected(static_cast<std::size_t>(tissue().soft.size()), Matrix3d::Identity());
    for (Eigen::Index i = 0; i < shape.tets.size(); ++i) {
      const auto at = std::lower_bound(tissue().soft.begin(), tissue().soft.end(), shape.tets[i]);
      const auto t = at - tissue().soft.begin();
      if (tissue().muscle[t] > 0)
        expected[static_cast<std::size_t>(t)] += activation_stretch(shape.stretch.row(i).transpose().cast<double>());
    }
    EXPECT_LT(largest_difference(blender.blend(VectorXd::Unit(3, j)), expected), 1e-6);
    EXPECT_EQ(blend_jaw(model().head.jaw, shapes(), VectorXd::Unit(3, j)),
              clamp_to_limits(model().head.jaw, shape.jaw));
  }
}

TEST(Activation, OfNoWeightsIsNeutral) {
  const ActivationBlender blender(shapes(), tissue());
  for (const Matrix3d& S : blender.blend(weights(0, 0, 0))) EXPECT_EQ(S, Matrix3d::Identity());
  EXPECT_EQ(blend_jaw(model().head.jaw, shapes(), weights(0, 0, 0)), JawPose::Zero());
}

TEST(Activation, IsLinearInTheWeights) {
  const ActivationBlender blender(shapes(), tissue());
  const auto pout = blender.blend(weights(0, 0.5, 0)), press = blender.blend(weights(0, 0, 0.25)),
             both = blender.blend(weights(0, 0.5, 0.25));
  for (std::size_t t = 0; t < both.size(); ++t)
    EXPECT_LT((both[t] - pout[t] - press[t] + Matrix3d::Identity()).norm(), 1e-6);
}

TEST(Activation, StaysWithinItsBoundsAndTheJawWithinItsLimits) {
  const ActivationBlender blender(shapes(), tissue());
  int bounded = 0;
  for (const double w : {-9.0, 9.0})
    for (const Matrix3d& S : blender.blend(weights(0, w, -w))) {
      EXPECT_EQ(S, S.transpose());
      const Vector3d s = Eigen::SelfAdjointEigenSolver<Matrix3d>(S).eigenvalues();
      EXPECT_GE(s[0], least_activation - 1e-9);
      EXPECT_LE(s[2], most_activation + 1e-9);
      bounded += s[0] < least_activation + 1e-9 || s[2] > most_activation - 1e-9;
    }
  EXPECT_GT(bounded, 10);
  EXPECT_EQ(blend_jaw(model().head.jaw, shapes(), weights(9, 0, 0))[0], model().head.jaw.upper[0]);
}

TEST(Activation, OfAParalysedMuscleIsNeutral) {
  auto stretches = ActivationBlender(shapes(), tissue()).blend(weights(0, 1, 0));
  const auto whole = stretches;
  scale_activation(innervation(model().head, tissue(), VectorXd::Ones(1)), stretches);
  EXPECT_EQ(largest_difference(stretches, whole), 0);
  scale_activation(innervation(model().head, tissue(), VectorXd::Zero(1)), stretches);
  for (const Matrix3d& S : stretches) EXPECT_EQ(S, Matrix3d::Identity());
  EXPECT_THROW(innervation(model().head, tissue(), VectorXd::Ones(2)), Error);
  EXPECT_THROW(scale_activation(VectorXd::Constant(tissue().soft.size(), 2), stretches), Error);
}

TEST(Activation, RefusesWhatIsMalformed) {
  EXPECT_THROW(ActivationBlender(shapes(), tissue()).blend(VectorXd::Ones(2)), Error);
  EXPECT_THROW(ActivationBlender(shapes(), tissue()).blend(weights(0, std::nan(""), 0)), Error);
  EXPECT_THROW(ActivationBlender(shapes(), tissue()).blend(weights(0, 1e300, 0)), Error);
  EXPECT_THROW(blend_jaw(model().head.jaw, shapes(), VectorXd::Ones(2)), Error);
  auto broken = shapes();
  broken[1].change.conservativeResize(3, 6);
  EXPECT_THROW(ActivationBlender(broken, tissue()), Error);
}

TEST(Calibration, BringsAnExpressionNearerToItsSculpt) {
  // Half muscle, no stiffer than the rest of the flesh.
  TissueOptions soft;
  soft.muscle_stiffness = 1;
  const HeadTissue weak = head_tissue(model().head, soft);
  auto estimated = estimate_activations(model(), weak);
  const auto before = calibrate_activations(model(), weak, estimated);
  auto again = estimated;
  const auto after = calibrate_activations(model(), weak, again);
  ASSERT_EQ(before.size(), 3U);
  EXPECT_EQ(before[0].gain, 1);  // the jaw moves
  for (const std::size_t j : {1U, 2U}) {
    EXPECT_TRUE(before[j].statistics.converged);
    EXPECT_LT(before[j].reached, 0.9);
    EXPECT_GT(before[j].gain, 1.1);
    EXPECT_LT(after[j].error, before[j].error);
    EXPECT_GT(after[j].reached, before[j].reached);
  }
  // Stiff muscle needs less of it.
  auto strong = shapes();
  const auto stiff = calibrate_activations(model(), tissue(), strong);
  for (const std::size_t j : {1U, 2U}) EXPECT_GT(stiff[j].reached, before[j].reached);
}

}  // namespace
}  // namespace phiz
