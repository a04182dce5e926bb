// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "face/small_face.h"
#include "phiz/core/error.h"
#include "phiz/face/activation.h"
#include "phiz/face/flesh.h"
#include "phiz/face/volumetric_blendshapes.h"
#include "phiz/geometry/operators.h"
#include "phiz/geometry/topology.h"

namespace phiz {
namespace {

using testing::small_weights;

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

const FaceModel& muscled_model() {
  static const FaceModel instance = face(0.6);
  return instance;
}
const HeadTissue& tissue() {
  static const HeadTissue instance = head_tissue(muscled_model().head);
  return instance;
}
std::vector<ActivationShape> shapes() {
  return estimate_activations(muscled_model(), tissue());
}
double largest_difference(const std::vector<Matrix3d>& a, const std::vector<Matrix3d>& b) {
  double most = 0;
  for (std::size_t t = 0; t < a.size(); ++t) most = std::max(most, (a[t] - b[t]).norm());
  return most;
}

/// Per tet of the volume: the changes of a shape, zero where it has none.
Eigen::MatrixXf on_all_tets(const VectorXi& tets, const Stretches& change) {
  Eigen::MatrixXf all = Eigen::MatrixXf::Zero(muscled_model().head.volume.T.rows(), 6);
  for (Eigen::Index i = 0; i < tets.size(); ++i) all.row(tets[i]) = change.row(i);
  return all;
}

TEST(Activation, OfOneShapeIsItsChangeAndJawPose) {
  const auto estimated = shapes();
  const ActivationBlender blender(estimated, tissue());
  for (int j = 0; j < 3; ++j) {
    const ActivationShape& shape = estimated[static_cast<std::size_t>(j)];
    const Eigen::MatrixXf change = on_all_tets(shape.tets, shape.change);
    std::vector<Matrix3d> expected;
    for (const int t : tissue().soft)
      expected.push_back(Matrix3d::Identity() + activation_stretch(change.row(t).transpose().cast<double>()));
    EXPECT_LT(largest_difference(blender.blend(VectorXd::Unit(3, j)), expected), 1e-6);
    EXPECT_EQ(blend_jaw(muscled_model().head.jaw, estimated, VectorXd::Unit(3, j)),
              clamp_to_limits(muscled_model().head.jaw, muscled_model().shapes[static_cast<std::size_t>(j)].jaw));
  }
}

TEST(Activation, IsEstimatedAsTheSmoothedStretchOfTheShapeWithItsMean) {
  const HeadTemplate& head = muscled_model().head;
  VectorXd muscle = VectorXd::Zero(head.volume.T.rows());
  for (Eigen::Index t = 0; t < tissue().soft.size(); ++t) muscle[tissue().soft[t]] = tissue().muscle[t];
  const VectorXd weight = muscle.cwiseProduct(tet_volumes(head.volume.V, head.volume.T));
  const MatrixX4i neighbours = tet_neighbours(head.volume.T);
  const auto estimated = shapes();
  for (std::size_t j = 1; j < 3; ++j) {
    const Eigen::MatrixXf sculpt = on_all_tets(muscled_model().shapes[j].tets, muscled_model().shapes[j].stretch),
                          estimate = on_all_tets(estimated[j].tets, estimated[j].change);
    const auto mean = [&](const Eigen::MatrixXf& m) { return Eigen::VectorXd(m.cast<double>().transpose() * weight); };
    EXPECT_LT((mean(sculpt) - mean(estimate)).norm(), 2e-3 * mean(sculpt).norm());
    const auto roughness = [&](const Eigen::MatrixXf& m) {
      double sum = 0;
      for (Eigen::Index t = 0; t < muscle.size(); ++t)
        for (const int other : neighbours.row(t))
          if (other >= 0 && muscle[t] > 0 && muscle[other] > 0)
            sum += static_cast<double>((m.row(t) - m.row(other)).squaredNorm());
      return sum;
    };
    EXPECT_LT(roughness(estimate), 0.3 * roughness(sculpt));
    EXPECT_EQ((estimate.rowwise().squaredNorm().array() > 0 && muscle.cast<float>().array() == 0).count(), 0);
  }
}

TEST(Activation, OfNoWeightsIsNeutral) {
  const ActivationBlender blender(shapes(), tissue());
  for (const Matrix3d& S : blender.blend(small_weights(0, 0, 0))) EXPECT_EQ(S, Matrix3d::Identity());
  EXPECT_EQ(blend_jaw(muscled_model().head.jaw, shapes(), small_weights(0, 0, 0)), JawPose::Zero());
}

TEST(Activation, IsLinearInTheWeights) {
  const ActivationBlender blender(shapes(), tissue());
  const auto pout = blender.blend(small_weights(0, 0.5, 0)), press = blender.blend(small_weights(0, 0, 0.25)),
             both = blender.blend(small_weights(0, 0.5, 0.25));
  for (std::size_t t = 0; t < both.size(); ++t)
    EXPECT_LT((both[t] - pout[t] - press[t] + Matrix3d::Identity()).norm(), 1e-6);
}

TEST(Activation, StaysWithinItsBoundsAndTheJawWithinItsLimits) {
  const ActivationBlender blender(shapes(), tissue());
  int bounded = 0;
  for (const double w : {-9.0, 9.0})
    for (const Matrix3d& S : blender.blend(small_weights(0, w, -w))) {
      EXPECT_EQ(S, S.transpose());
      const Vector3d s = Eigen::SelfAdjointEigenSolver<Matrix3d>(S).eigenvalues();
      EXPECT_GE(s[0], least_activation - 1e-6);
      EXPECT_LE(s[2], most_activation + 1e-6);
      bounded += s[0] < least_activation + 1e-6 || s[2] > most_activation - 1e-6;
    }
  EXPECT_GT(bounded, 10);
  EXPECT_EQ(blend_jaw(muscled_model().head.jaw, shapes(), small_weights(9, 0, 0))[0],
            muscled_model().head.jaw.upper[0]);
}

TEST(Activation, OfAParalysedMuscleIsNeutral) {
  const ActivationBlender blender(shapes(), tissue());
  Stretches stretches;
  blender.blend(small_weights(0, 1, 0), stretches);
  const Stretches whole = stretches;
  scale_activation(innervation(muscled_model().head, tissue(), VectorXd::Ones(1))(blender.tets()), stretches);
  EXPECT_EQ(stretches, whole);
  scale_activation(innervation(muscled_model().head, tissue(), VectorXd::Zero(1))(blender.tets()), stretches);
  for (const auto& S : stretches.rowwise()) EXPECT_EQ(S, (Eigen::RowVector<float, 6>(1, 1, 1, 0, 0, 0)));
  EXPECT_THROW(innervation(muscled_model().head, tissue(), VectorXd::Ones(2)), Error);
  EXPECT_THROW(scale_activation(VectorXd::Constant(stretches.rows(), 2), stretches), Error);
  EXPECT_THROW(scale_activation(VectorXd::Ones(1), stretches), Error);
}

TEST(Activation, RefusesWhatIsMalformed) {
  EXPECT_THROW(ActivationBlender(shapes(), tissue()).blend(VectorXd::Ones(2)), Error);
  EXPECT_THROW(ActivationBlender(shapes(), tissue()).blend(small_weights(0, std::nan(""), 0)), Error);
  EXPECT_THROW(ActivationBlender(shapes(), tissue()).blend(small_weights(0, 1e300, 0)), Error);
  EXPECT_THROW(blend_jaw(muscled_model().head.jaw, shapes(), VectorXd::Ones(2)), Error);
  auto broken = shapes();
  broken[1].change.conservativeResize(3, 6);
  EXPECT_THROW(ActivationBlender(broken, tissue()), Error);
}

}  // namespace
}  // namespace phiz
