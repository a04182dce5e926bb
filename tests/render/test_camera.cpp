// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "phiz/core/error.h"
#include "phiz/render/camera.h"
#include "render/shapes.h"

namespace phiz {
namespace {

TEST(Camera, WholeHeadViewsShowEveryPoint) {
  MatrixX3d points = test::sphere(0.1, 3).V;
  points.col(1) *= 1.4;
  points.rowwise() += Eigen::RowVector3d(0.3, -0.2, 0.1);
  const FacePoints face = guess_face_points(points);
  for (const View view : {View::front, View::three_quarter, View::three_quarter_right, View::side, View::side_right,
                          View::back, View::top, View::below}) {
    for (const auto& [width, height] : {std::pair{400, 400}, std::pair{300, 500}, std::pair{640, 360}}) {
      const Camera camera = frame_view(view, points, face, width, height);
      double low_x = width, high_x = 0, low_y = height, high_y = 0;
      for (Eigen::Index i = 0; i < points.rows(); ++i) {
        const Vector3d p = project(camera, points.row(i));
        low_x = std::min(low_x, p.x());
        high_x = std::max(high_x, p.x());
        low_y = std::min(low_y, p.y());
        high_y = std::max(high_y, p.y());
      }
      EXPECT_GT(low_x, 0) << view_name(view);
      EXPECT_LT(high_x, width) << view_name(view);
      EXPECT_GT(low_y, 0) << view_name(view);
      EXPECT_LT(high_y, height) << view_name(view);
      const double fill = std::max((high_x - low_x) / width, (high_y - low_y) / height);
      EXPECT_GT(fill, 0.8) << view_name(view);  // and it fills the picture
    }
  }
}

TEST(Camera, NamesAndViewsGoTogether) {
  for (const View view : all_views()) EXPECT_EQ(view_from_name(view_name(view)), view);
  EXPECT_THROW(view_from_name("upside-down"), Error);
}

TEST(Camera, PersonsLeftIsOnTheRightOfAFrontView) {
  const MatrixX3d points = test::sphere(0.1, 3).V;
  const Camera camera = frame_view(View::front, points, guess_face_points(points), 200, 200);
  EXPECT_GT(project(camera, {0.05, 0, 0}).x(), 100);
  EXPECT_LT(project(camera, {0, 0.05, 0}).y(), 100);
}

}  // namespace
}  // namespace phiz
