// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "face/small_face.h"
#include "phiz/core/random.h"
#include "phiz/face/blend.h"
#include "phiz/face/flesh.h"
#include "phiz/face/surface_gradients.h"
#include "phiz/face/volumetric_blendshapes.h"

namespace phiz {
namespace {

using Stretches = Eigen::Matrix<double, Eigen::Dynamic, 6>;

struct TetShapes {
  MatrixX3d logs;
  Stretches stretches;
  std::vector<Matrix3d> gradients;
};

TetShapes random_shapes(int count, std::uint64_t seed) {
  Random random(seed);
  TetShapes out;
  out.logs.resize(count, 3);
  out.stretches.resize(count, 6);
  for (int m = 0; m < count; ++m) {
    for (int k = 0; k < 3; ++k) out.logs(m, k) = 0.4 * random.normal();
    for (int k = 0; k < 6; ++k) out.stretches(m, k) = 0.05 * random.normal();
    VectorXd unit = VectorXd::Zero(count);
    unit[m] = 1;
    out.gradients.push_back(polar_blend(out.logs, out.stretches, unit));
  }
  return out;
}

TEST(Blend, OneShapeAtFullWeightIsThatShape) {
  const TetShapes shapes = random_shapes(5, 1);
  for (int m = 0; m < 5; ++m) {
    VectorXd unit = VectorXd::Zero(5);
    unit[m] = 1;
    EXPECT_LT(
        (linear_blend(shapes.logs, shapes.stretches, unit) - shapes.gradients[static_cast<std::size_t>(m)]).norm(),
        1e-12);
  }
}

TEST(Blend, ZeroWeightsAreTheIdentity) {
  const TetShapes shapes = random_shapes(5, 2);
  EXPECT_LT((polar_blend(shapes.logs, shapes.stretches, VectorXd::Zero(5)) - Matrix3d::Identity()).norm(), 1e-15);
}

TEST(Blend, PureRotationsBlendToPureRotationsOnTheArc) {
  MatrixX3d logs(1, 3);
  logs.row(0) = 0.6 * Vector3d::UnitX();
  const Stretches none = Stretches::Zero(1, 6);
  for (double w = 0; w <= 1; w += 0.125) {
    const Matrix3d R = polar_blend(logs, none, VectorXd::Constant(1, w));
    EXPECT_LT((R - Eigen::AngleAxisd(0.6 * w, Vector3d::UnitX()).toRotationMatrix()).norm(), 1e-14);
    if (w > 0 && w < 1) {
      EXPECT_LT(linear_blend(logs, none, VectorXd::Constant(1, w)).determinant(), 1 - 1e-3);
    }
  }
}

TEST(Blend, StoredGradientsComeBack) {
  Random random(3);
  std::vector<Matrix3d> gradients(20, Matrix3d::Identity());
  for (std::size_t t = 0; t < 15; ++t) {
    for (int k = 0; k < 9; ++k) gradients[t].data()[k] += 0.3 * random.normal();
    if (gradients[t].determinant() < 0.1) gradients[t].setIdentity();
  }
  const VectorXi tets = VectorXi::LinSpaced(20, 100, 119);
  const VolumetricShape shape = shape_of_gradients("x", JawPose::Zero(), tets, gradients, 1e-4);
  EXPECT_LE(shape.tets.size(), 15);
  for (Eigen::Index i = 0; i < shape.tets.size(); ++i) {
    const Matrix3d F =
        polar_blend(shape.log_rotation.row(i).cast<double>(), shape.stretch.row(i).cast<double>(), VectorXd::Ones(1));
    EXPECT_LT((F - gradients[static_cast<std::size_t>(shape.tets[i] - 100)]).norm(), 1e-5);
  }
}

TEST(Blend, AllTetsAtOnceAgreeWithOneByOne) {
  const FaceModel model = build_volumetric_blendshapes(testing::small_head());
  const VectorXi soft = soft_tets(model.head);
  ElementBlocks<float> elements(model.head.volume.V, model.head.volume.T(soft, Eigen::all), VectorXd::Ones(soft.size()),
                                {});
  std::vector<std::ptrdiff_t> slot(static_cast<std::size_t>(soft.size()));
  for (std::size_t t = 0; t < slot.size(); ++t) slot[t] = static_cast<std::ptrdiff_t>(t);
  const TargetBlender blender(model, soft, slot);
  VectorXd weights(3);
  weights << 0.7, 0.4, -0.2;
  blender.blend(weights, elements);
  for (Eigen::Index t = 0; t < soft.size(); t += 7) {
    MatrixX3d logs = MatrixX3d::Zero(3, 3);
    Stretches stretches = Stretches::Zero(3, 6);
    for (int m = 0; m < 3; ++m) {
      const VolumetricShape& shape = model.shapes[static_cast<std::size_t>(m)];
      for (Eigen::Index i = 0; i < shape.tets.size(); ++i)
        if (shape.tets[i] == soft[t]) {
          logs.row(m) = shape.log_rotation.row(i).cast<double>();
          stretches.row(m) = shape.stretch.row(i).cast<double>();
        }
    }
    const Matrix3d expected = polar_blend(logs, stretches, weights);
    for (int k = 0; k < 9; ++k)  // shapes are stored in 16 bits
      EXPECT_NEAR(elements.target[ElementBlocks<float>::at(t, 9, k)], expected.data()[k], 1e-5);
  }
}

TEST(Blend, JawIsRigidAndWithinItsLimitsForAllWeights) {
  const FaceModel model = build_volumetric_blendshapes(testing::small_head());
  Random random(4);
  for (int i = 0; i < 50; ++i) {
    VectorXd weights(3);
    for (int k = 0; k < 3; ++k) weights[k] = random.uniform(-1, 3);
    const JawPose pose = blend_jaw(model, weights);
    EXPECT_TRUE((pose.array() <= model.head.jaw.upper.array()).all());
    EXPECT_TRUE((pose.array() >= model.head.jaw.lower.array()).all());
    MatrixX3d x = model.head.volume.V;
    place_bones(model.head, pose, x);
    const Eigen::Isometry3d jaw = jaw_transform(model.head.jaw, pose);
    EXPECT_LT((jaw.linear() * jaw.linear().transpose() - Matrix3d::Identity()).norm(), 1e-14);
    for (Eigen::Index v = 0; v < x.rows(); ++v) {
      const Vector3d rest = model.head.volume.V.row(v);
      if (model.head.carrier[v] == static_cast<int>(Carrier::mandible)) {
        EXPECT_LT((x.row(v).transpose() - jaw * rest).norm(), 1e-15);
      } else {
        EXPECT_EQ((x.row(v).transpose() - rest).norm(), 0.0);
      }
    }
  }
}

TEST(SurfaceGradients, FollowAnAffineMap) {
  const MatrixX3d V = (MatrixX3d(4, 3) << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0.2, 0.3, 1).finished();
  const MatrixX3i F = (MatrixX3i(2, 3) << 0, 1, 2, 0, 2, 3).finished();
  const Matrix3d R = Eigen::AngleAxisd(0.5, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  for (const Matrix3d& G : surface_gradients(V, V * R.transpose(), F)) EXPECT_LT((G - R).norm(), 1e-12);
  for (const Matrix3d& G : surface_gradients(V, 2 * V, F)) EXPECT_LT((G - 2 * Matrix3d::Identity()).norm(), 1e-12);
}

}  // namespace
}  // namespace phiz
