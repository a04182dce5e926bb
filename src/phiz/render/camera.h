// SPDX-License-Identifier: GPL-3.0-or-later
/// The camera, and the standard views of a head.
#pragma once

#include <Eigen/Geometry>
#include <string_view>
#include <vector>

#include "phiz/geometry/mesh.h"

namespace phiz {

/// A pinhole camera. Pixel (0, 0) is the top left one; pixel centres lie at half-integers.
struct Camera {
  Vector3d eye{0, 0, 1};
  Vector3d target{0, 0, 0};
  Vector3d up{0, 1, 0};
  double vertical_fov = 0.30;  ///< radians, over the height of the picture (0.30: a portrait lens)
  double near = 0;             ///< nothing nearer than this along the viewing axis is seen
  int width = 640;
  int height = 640;
};

/// Right, up and backward unit vectors of the camera as columns. Throws phiz::Error(bad_input) for a degenerate camera.
Matrix3d camera_axes(const Camera& camera);

/// Pixel coordinates of a world point (x to the right, y down) and its distance along the viewing axis.
Vector3d project(const Camera& camera, const Vector3d& point);

/// Where the parts of a face are, for framing.
struct FacePoints {
  Vector3d left_eye, right_eye, nose_tip, mouth, left_ear, chin;
  double unit = 1;  ///< size of this head relative to an average adult in metres (1 when the file is in metres)
};

/// Guesses the face points of a head that looks along +z with +y up, from the outermost point of the face and the width
/// of the head. Any unit. Good enough for framing.
FacePoints guess_face_points(const MatrixX3d& points);

enum class View {
  front,
  three_quarter,
  three_quarter_right,
  side,
  side_right,
  back,
  top,
  below,
  face,
  mouth,
  left_eye,
  right_eye,
  eyes,
  nose,
  ear
};

/// The names that the command and the pictures use: "front", "three-quarter", "side", "mouth", "left-eye" ...
std::string_view view_name(View view);
/// Throws phiz::Error(usage) naming the known views.
View view_from_name(std::string_view name);
const std::vector<View>& all_views();

/// Camera for a view. Whole-head views fit all `points` (world, n x 3) with a margin; close-ups use `face`.
/// Perspective of an 85 mm portrait lens. `width`, `height` in pixels.
Camera frame_view(View view, const MatrixX3d& points, const FacePoints& face, int width, int height);

/// Camera that looks along `direction` and fits all points with a margin of `margin` of the picture on each side.
Camera frame_points(const MatrixX3d& points, const Vector3d& direction, const Vector3d& up, int width, int height,
                    double margin = 0.06);

}  // namespace phiz
