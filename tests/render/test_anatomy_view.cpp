// SPDX-License-Identifier: GPL-3.0-or-later
// What the styles muscles, fibres, cutaway, attachments and contacts show of a head made of a few boxes.
#include <gtest/gtest.h>

#include <string>

#include "phiz/core/error.h"
#include "phiz/render/head_view.h"
#include "phiz/render/palette.h"
#include "phiz/render/render.h"
#include "render/shapes.h"

namespace phiz {
namespace {

/// A box between two corners as five tets, appended to a mesh.
void add_box(TetMesh& mesh, const Vector3d& low, const Vector3d& high, int region) {
  const Eigen::Index first = mesh.V.rows(), tets = mesh.T.rows();
  mesh.V.conservativeResize(first + 8, 3);
  mesh.V.bottomRows(8) = test::box(low, high).V;
  mesh.T.conservativeResize(tets + 5, 4);
  mesh.T.bottomRows(5) << 0, 1, 2, 4, 3, 2, 1, 7, 5, 4, 7, 1, 6, 7, 4, 2, 1, 2, 4, 7;
  mesh.T.bottomRows(5).array() += static_cast<int>(first);
  mesh.region.conservativeResize(tets + 5);
  mesh.region.tail(5).setConstant(region);
}

/// A spindle that fills a box, with one fibre down its axis.
Muscle spindle(const std::string& name, const Vector3d& low, const Vector3d& high) {
  Muscle muscle;
  muscle.name = name;
  const Vector3d middle = (low + high) / 2;
  muscle.surface = test::sphere(0.5, 4);
  muscle.surface.V *= (high - low).asDiagonal();
  muscle.surface.V.rowwise() += middle.transpose();
  MatrixX3d fibre(3, 3);
  fibre << middle.x(), high.y(), middle.z(), middle.transpose(), middle.x(), low.y(), middle.z();
  muscle.fibres = {fibre};
  return muscle;
}

/// A block of flesh 12 cm wide with a bone inside and a muscle on either side before it.
HeadTemplate block_head() {
  HeadTemplate head;
  head.name = "block";
  head.skin = test::box({-0.06, -0.06, -0.06}, {0.06, 0.06, 0.06});
  add_box(head.volume, {-0.06, -0.06, -0.06}, {0.06, 0.06, 0.06}, Tissue::flesh);
  add_box(head.volume, {-0.03, -0.03, -0.03}, {0.03, 0.03, 0.01}, Tissue::skull);
  head.muscles = {spindle("masseterLeft", {0.01, -0.03, 0.02}, {0.04, 0.03, 0.05}),
                  spindle("masseterRight", {-0.04, -0.03, 0.02}, {-0.01, 0.03, 0.05})};
  head.left_eye_centre = {0.03, 0.02, 0.09};
  head.right_eye_centre = {-0.03, 0.02, 0.09};
  Part skull;
  skull.name = "skull";
  skull.mesh = test::box({-0.03, -0.03, -0.03}, {0.03, 0.03, 0.01});
  head.parts.push_back(skull);
  return head;
}

/// The picture from the front, and its linear colour where a point of the head is seen.
class Seen {
 public:
  explicit Seen(const Scene& scene) {
    camera_.eye = {0, 0, 2};
    camera_.vertical_fov = 0.08;
    camera_.width = camera_.height = 160;
    image_ = render(scene, camera_);
  }
  Vector3d at(const Vector3d& point) const {
    const Vector3d p = project(camera_, point);
    const std::uint8_t* pixel = image_.at(static_cast<int>(p.x()), static_cast<int>(p.y()));
    return Vector3d(pixel[0], pixel[1], pixel[2]) / 255;
  }

 private:
  Camera camera_;
  Image image_;
};

bool is_red(const Vector3d& c) {
  return c.x() > 1.6 * c.y() && c.x() > 1.6 * c.z();
}
bool is_blue(const Vector3d& c) {
  return c.z() > 1.3 * c.x() && c.z() > 1.1 * c.y();
}
bool is_yellow(const Vector3d& c) {
  return c.x() > c.y() && c.y() > 1.2 * c.z();
}
bool is_bone(const Vector3d& c) {
  return c.minCoeff() > 0.6 * c.maxCoeff() && c.x() > c.z();
}

HeadViewOptions with_style(const char* style) {
  HeadViewOptions options;
  options.style = head_style(style);
  return options;
}

std::string refusal(const HeadTemplate& head, const HeadViewOptions& options) {
  try {
    head_scene(head, options);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    return error.what();
  }
  return {};
}

TEST(AnatomyView, MusclesAreRedOverBoneWithoutSkin) {
  const Scene scene = head_scene(block_head(), with_style("muscles"));
  EXPECT_EQ(test::find(scene, "skin"), nullptr);
  const Seen seen(scene);
  EXPECT_TRUE(is_red(seen.at({0.025, 0, 0.05})));
  EXPECT_TRUE(is_red(seen.at({-0.025, 0, 0.05})));
  EXPECT_TRUE(is_bone(seen.at({0, 0, 0.01})));
}

TEST(AnatomyView, StreaksFollowTheFibres) {
  const Scene scene = head_scene(block_head(), with_style("muscles"));
  const Surface* belly = test::find(scene, "masseterLeft");
  ASSERT_NE(belly, nullptr);
  for (Eigen::Index v = 0; v < belly->fibre.rows(); ++v)
    EXPECT_LT((belly->fibre.row(v) + Eigen::RowVector3d::UnitY()).norm(), 1e-9);  // from the top down
}

TEST(AnatomyView, PeeledSkinStaysOnOneSide) {
  HeadViewOptions options = with_style("muscles");
  options.peel = CutPlane{Vector3d::Zero(), Vector3d::UnitX()};
  const Seen seen(head_scene(block_head(), options));
  EXPECT_TRUE(is_red(seen.at({0.025, 0, 0.05})));
  const Vector3d skin = seen.at({-0.025, 0, 0.06});
  EXPECT_FALSE(is_red(skin));
  EXPECT_GT(skin.x(), 1.15 * skin.z());
}

TEST(AnatomyView, NamesChooseMusclesWithOrWithoutTheirSide) {
  const HeadTemplate head = block_head();
  HeadViewOptions options = with_style("muscles");
  options.muscles = {"masseter"};
  EXPECT_NE(test::find(head_scene(head, options), "masseterLeft"), nullptr);
  EXPECT_NE(test::find(head_scene(head, options), "masseterRight"), nullptr);
  options.muscles = {"Masseter left"};
  EXPECT_NE(test::find(head_scene(head, options), "masseterLeft"), nullptr);
  EXPECT_EQ(test::find(head_scene(head, options), "masseterRight"), nullptr);
}

TEST(AnatomyView, UnknownMusclesAreRefusedWithTheNearestNames) {
  HeadTemplate head = block_head();
  head.muscles.push_back(spindle("procerus", {0, 0, 0}, {0.01, 0.01, 0.01}));
  HeadViewOptions options = with_style("fibres");
  options.muscles = {"maseter"};
  EXPECT_NE(refusal(head, options).find("no muscle 'maseter'; the nearest names are masseter, procerus"),
            std::string::npos);
  head.muscles.clear();
  EXPECT_NE(refusal(head, options).find("block has no muscles"), std::string::npos);
}

TEST(AnatomyView, HeadsWithoutMusclesShowTheirBones) {
  HeadTemplate head = block_head();
  head.muscles.clear();
  for (const char* style : {"muscles", "fibres", "cutaway", "attachments", "contacts", "anatomy"})
    EXPECT_NO_THROW(Seen(head_scene(head, with_style(style)))) << style;
}

TEST(AnatomyView, MusclesWithoutASurfaceAreDrawnAsTheirFibres) {
  HeadTemplate head = block_head();
  head.muscles[0].surface = TriangleMesh();
  const Scene scene = head_scene(head, with_style("muscles"));
  ASSERT_NE(test::find(scene, "masseterLeft"), nullptr);
  EXPECT_TRUE(is_red(Seen(scene).at({0.025, 0, 0.035})));
}

TEST(AnatomyView, FibresGoFromWhiteAtTheOriginToRedAtTheInsertion) {
  const HeadTemplate head = block_head();
  const Scene scene = head_scene(head, with_style("fibres"));
  const Surface* tubes = test::find(scene, "masseterLeft");
  ASSERT_NE(tubes, nullptr);
  const Vector3d first = tubes->colour.row(0), last = tubes->colour.bottomRows(1).transpose();
  EXPECT_GT(first.minCoeff(), 0.5);
  EXPECT_TRUE(is_red(last));
  const auto legend = head_legend(head, with_style("fibres"));
  ASSERT_EQ(legend.size(), 2U);
  EXPECT_EQ(legend[0].colour, first);
  EXPECT_LT((legend[1].colour - last).norm(), 1e-12);
}

TEST(AnatomyView, CutsShowFleshMuscleBoneAndSkinInTheirColours) {
  HeadViewOptions options = with_style("cutaway");
  options.plane = {Vector3d(0, 0, 0.03), Vector3d::UnitZ()};
  const Seen before_bone(head_scene(block_head(), options));
  EXPECT_TRUE(is_red(before_bone.at({0.025, 0, 0.03})));
  EXPECT_TRUE(is_yellow(before_bone.at({0, 0, 0.03})));
  const Vector3d skin = before_bone.at({0, 0.0592, 0.03}), flesh = before_bone.at({0, 0.05, 0.03});
  EXPECT_GT(skin.z(), 1.15 * flesh.z());
  options.plane.point.z() = 0;
  const Seen through_bone(head_scene(block_head(), options));
  EXPECT_TRUE(is_bone(through_bone.at({0, 0, 0})));
  EXPECT_TRUE(is_yellow(through_bone.at({0.05, 0, 0})));
}

TEST(AnatomyView, CutsShowTheShareThatMusclesWithoutASurfaceFill) {
  HeadTemplate head = block_head();
  for (Muscle& muscle : head.muscles) muscle.surface = TriangleMesh();
  head.muscles[0].tets = VectorXi::LinSpaced(5, 0, 4);
  head.muscles[0].fraction = VectorXd::Ones(5);
  HeadViewOptions options = with_style("cutaway");
  options.plane = {Vector3d(0, 0, 0.03), Vector3d::UnitZ()};
  EXPECT_TRUE(is_red(Seen(head_scene(head, options)).at({0.02, 0.02, 0.03})));
}

TEST(AnatomyView, AttachmentsPaintBonesByHowFleshSitsOnThem) {
  HeadTemplate head = block_head();
  // The bone's corners are rows 8 to 15: pinned on the left (odd), sliding on the right.
  head.attachments.vertices = VectorXi::LinSpaced(8, 8, 15);
  head.attachments.hold.resize(8);
  for (int i = 0; i < 8; ++i) head.attachments.hold[i] = static_cast<int>(i % 2 == 1 ? Hold::pin : Hold::slide);
  head.attachments.normals = MatrixX3d::Constant(8, 3, std::sqrt(1.0 / 3));
  const Seen seen(head_scene(head, with_style("attachments")));
  EXPECT_TRUE(is_red(seen.at({0.025, 0.025, 0.01})));
  EXPECT_TRUE(is_blue(seen.at({-0.025, 0.025, 0.01})));
  head.attachments = Attachments();
  EXPECT_TRUE(is_bone(Seen(head_scene(head, with_style("attachments"))).at({0.025, 0.025, 0.01})));
}

TEST(AnatomyView, ContactRegionsArePaintedOnTheSkin) {
  HeadTemplate head = block_head();
  // The drawn skin is the simulation skin; its front is a region.
  head.skin_vertices = VectorXi::LinSpaced(8, 0, 7);
  head.skin_interpolation.resize(8, 8);
  head.skin_interpolation.setIdentity();
  head.contact_regions.resize(1);
  head.contact_regions[0].name = "upperLip";
  head.contact_regions[0].vertices = VectorXi::LinSpaced(4, 4, 7);
  const HeadViewOptions options = with_style("contacts");
  const Scene scene = head_scene(head, options);
  ASSERT_NE(test::find(scene, "upperLip"), nullptr);
  const auto legend = head_legend(head, options);
  ASSERT_EQ(legend.size(), 1U);
  EXPECT_EQ(legend[0].name, "upper lip");
  EXPECT_EQ(test::find(scene, "upperLip")->material.albedo, legend[0].colour);
}

TEST(AnatomyView, LegendsNameEachMuscleOnce) {
  HeadViewOptions options = with_style("muscles");
  EXPECT_TRUE(head_legend(block_head(), options).empty());
  options.muscle_colours = true;
  const auto legend = head_legend(block_head(), options);
  ASSERT_EQ(legend.size(), 1U);
  EXPECT_EQ(legend[0].name, "masseter");
}

TEST(AnatomyView, MusclesMoveWithTheTetsOfATake) {
  const HeadTemplate head = block_head();
  Take take = rest_take(head);
  TakeFrame& frame = take.frames.front();
  frame.volume = head.volume.V.cast<float>();
  frame.volume.col(1).array() += 0.004F;
  const HeadViewOptions options = with_style("muscles");
  const Scene rest = head_scene(head, options), moved = head_scene(take, frame, options, &head);
  const MatrixX3d by = test::find(moved, "masseterLeft")->mesh.V - test::find(rest, "masseterLeft")->mesh.V;
  EXPECT_LT((by.rowwise() - Eigen::RowVector3d(0, 0.004, 0)).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(AnatomyView, TakesNeedTheirHead) {
  const HeadTemplate head = block_head();
  Take take = rest_take(head);
  EXPECT_THROW(head_scene(take, take.frames.front(), with_style("muscles")), Error);
  EXPECT_NO_THROW(head_scene(take, take.frames.front(), with_style("muscles"), &head));
}

}  // namespace
}  // namespace phiz
