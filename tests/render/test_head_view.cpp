// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "phiz/core/error.h"
#include "phiz/render/head_paint.h"
#include "phiz/render/head_quantities.h"
#include "phiz/render/head_view.h"
#include "phiz/render/render.h"
#include "render/shapes.h"

namespace phiz {
namespace {

/// A ball of skin with a bone inside, one tet of flesh, a jaw part, two eyes and one expression.
HeadTemplate toy_head() {
  HeadTemplate head;
  head.name = "toy";
  head.skin = test::sphere(0.1, 4);
  head.volume.V.resize(4, 3);
  head.volume.V << 0, 0, 0, 0.02, 0, 0, 0, 0.02, 0, 0, 0, 0.02;
  head.volume.T.resize(1, 4);
  head.volume.T << 0, 1, 2, 3;
  head.volume.region = VectorXi::Constant(1, Tissue::skull);
  head.left_eye_centre = {0.03, 0.02, 0.09};
  head.right_eye_centre = {-0.03, 0.02, 0.09};
  const auto part = [&](const char* name, Carrier carrier, const TriangleMesh& mesh, const Vector3d& at) {
    Part p;
    p.name = name;
    p.carrier = carrier;
    p.mesh = mesh;
    p.mesh.V.rowwise() += at.transpose();
    head.parts.push_back(p);
  };
  part("skull", Carrier::skull, test::sphere(0.05, 3), Vector3d::Zero());
  part("lowerTeeth", Carrier::mandible, test::sphere(0.02, 3), {0, -0.03, 0.06});
  part("leftEye", Carrier::left_eye, test::sphere(0.012, 4), head.left_eye_centre);
  part("rightEye", Carrier::right_eye, test::sphere(0.012, 4), head.right_eye_centre);
  Expression open;
  open.name = "jawOpen";
  open.displacement = MatrixX3d::Zero(head.skin.V.rows(), 3);
  open.displacement.col(1).setConstant(-0.01);
  open.jaw[0] = 0.4;
  head.expressions.push_back(open);
  return head;
}

Take toy_take(const HeadTemplate& head) {
  Take take = rest_take(head);
  take.frames.clear();
  for (int i = 0; i < 2; ++i) {
    TakeFrame frame;
    frame.time = 0.5 * i;
    frame.skin = head.skin.V.cast<float>();
    frame.skin.col(2).array() += 0.003F * static_cast<float>(i);
    frame.head.translation() = Vector3d(0.2 * i, 0, 0);
    take.frames.push_back(frame);
  }
  return take;
}

TEST(HeadView, StylesShowWhatTheyPromise) {
  const HeadTemplate head = toy_head();
  HeadViewOptions options;
  for (const char* name : {"clay", "skin", "wireframe", "anatomy", "bones", "cutaway"}) {
    options.style = head_style(name);
    const Scene scene = head_scene(head, options);
    const bool inside = options.style == HeadStyle::anatomy || options.style == HeadStyle::bones;
    EXPECT_EQ(test::find(scene, "skull") != nullptr, inside || options.style == HeadStyle::cutaway) << name;
    EXPECT_EQ(test::find(scene, "skin") == nullptr, options.style == HeadStyle::bones) << name;
    EXPECT_NE(test::find(scene, "leftEye"), nullptr) << name;
    EXPECT_NO_THROW(render(scene, head_camera(head, View::three_quarter, 40, 40))) << name;
  }
  EXPECT_THROW(head_style("marble"), Error);
}

TEST(HeadView, ExpressionsMoveSkinAndJaw) {
  const HeadTemplate head = toy_head();
  HeadViewOptions options;
  options.expressions = {{"jawOpen", 0.5}};
  const Scene scene = head_scene(head, options);
  EXPECT_LT(
      (test::find(scene, "skin")->mesh.V - head.skin.V - 0.5 * head.expressions[0].displacement).cwiseAbs().maxCoeff(),
      1e-15);
  JawPose pose = JawPose::Zero();
  pose[0] = 0.2;
  EXPECT_TRUE(test::find(scene, "lowerTeeth")->transform.isApprox(jaw_transform(head.jaw, pose)));
  options.expressions = {{"noSuchShape", 1.0}};
  EXPECT_THROW(head_scene(head, options), Error);
}

TEST(HeadView, TakesMoveWithTheHeadUnlessItIsHeldStill) {
  const HeadTemplate head = toy_head();
  const Take take = toy_take(head);
  HeadViewOptions options;
  const Scene moving = head_scene(take, take.frames[1], options);
  EXPECT_NEAR(test::find(moving, "skin")->transform.translation().x(), 0.2, 1e-12);
  EXPECT_NEAR(test::find(moving, "leftEye")->transform.translation().x(), 0.2, 1e-12);
  options.still_head = true;
  const Scene still = head_scene(take, take.frames[1], options);
  EXPECT_NEAR(test::find(still, "skin")->transform.translation().norm(), 0, 1e-12);
  EXPECT_NEAR(test::find(still, "leftEye")->transform.translation().norm(), 0, 1e-12);
}

TEST(HeadView, TheCameraOfATakeSeesAllOfItsMotion) {
  const HeadTemplate head = toy_head();
  const Take take = toy_take(head);
  const Camera camera = take_camera(take, View::front, 300, 300);
  for (const TakeFrame& frame : take.frames) {
    for (Eigen::Index i = 0; i < frame.skin.rows(); ++i) {
      const Vector3d p = project(camera, frame.head * Vector3d(frame.skin.row(i).cast<double>()));
      ASSERT_TRUE(p.x() > 0 && p.x() < 300 && p.y() > 0 && p.y() < 300);
    }
  }
}

TEST(HeadView, RefusesAHeadOfAnotherMesh) {
  const HeadTemplate head = toy_head();
  Take take = toy_take(head);
  HeadTemplate other = head;
  other.skin = test::sphere(0.1, 2);
  EXPECT_THROW(head_scene(take, take.frames[0], {}, &other), Error);
  take.frames[0].skin.conservativeResize(5, 3);
  EXPECT_THROW(head_scene(take, take.frames[0], {}), Error);
}

TEST(HeadQuantities, DisplacementSpeedAndStretchOfATranslation) {
  const HeadTemplate head = toy_head();
  const Take take = toy_take(head);
  const VectorXd displacement = skin_displacement(take, take.frames[1]),
                 speed = skin_speed(take.frames[0], take.frames[1]), stretch = skin_stretch(take, take.frames[1]);
  for (Eigen::Index i = 0; i < displacement.size(); ++i) {
    EXPECT_NEAR(displacement[i], 3, 1e-4);
    EXPECT_NEAR(speed[i], 6, 2e-4);
    EXPECT_NEAR(stretch[i], 0, 0.01);
  }
}

TEST(HeadQuantities, StretchOfAScalingIsItsSquare) {
  const HeadTemplate head = toy_head();
  Take take = toy_take(head);
  take.frames[0].skin *= 1.1F;
  const VectorXd stretch = skin_stretch(take, take.frames[0]);
  EXPECT_NEAR(stretch.minCoeff(), 21, 0.01);
  EXPECT_NEAR(stretch.maxCoeff(), 21, 0.01);
}

TEST(HeadQuantities, SkinPushedIntoTheTeethIsMeasured) {
  const HeadTemplate head = toy_head();
  Take take = toy_take(head);
  EXPECT_EQ(teeth_penetration(take, take.frames[0]).maxCoeff(), 0);
  take.frames[0].skin.row(7) << 0, -0.03F, 0.06F + 0.015F;  // 5 mm below the surface of a ball of 20 mm
  const VectorXd depth = teeth_penetration(take, take.frames[0]);
  EXPECT_NEAR(depth[7], 5, 0.2);
  EXPECT_EQ(depth.sum(), depth[7]);
}

TEST(HeadPaint, LipsAreRedderThanTheRest) {
  const HeadTemplate head = toy_head();
  VectorXi cap(20);
  for (int i = 0; i < 20; ++i) cap[i] = i;
  const MatrixX3d plain = paint_skin(head.skin, {}),
                  painted = paint_skin(head.skin, {{"lowerLip", cap}, {"unheardOf", cap}});
  EXPECT_LT((plain - MatrixX3d::Ones(plain.rows(), 3)).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_GT(painted(0, 0) / painted(0, 1), 1.1);
  EXPECT_TRUE((painted.array() > 0).all() && (painted.array() < 1.1).all());
}

TEST(HeadPaint, EyeHasADarkPupilAndAWhiteOfTheEye) {
  const auto eye = eye_pattern({0.03, 0, 0}, 0.012);
  EXPECT_LT(eye({0.03, 0, 0.012}).maxCoeff(), 0.05);
  EXPECT_GT(eye({0.042, 0, 0.0}).minCoeff(), 0.5);
  EXPECT_GT(eye({0.03, 0, -0.012}).minCoeff(), 0.5);
}

}  // namespace
}  // namespace phiz
