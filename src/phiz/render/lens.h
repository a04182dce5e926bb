// SPDX-License-Identifier: GPL-3.0-or-later
/// Internal: the camera in single precision, ready to make rays. Included by sources only.
#pragma once

#include <cmath>

#include "phiz/render/camera.h"

namespace phiz::detail {

using Eigen::Vector3f;

struct Lens {
  Vector3f eye, right, up, back;
  float focal = 1;  // pixels per unit of slope
  float middle_x = 0, middle_y = 0, near = 0;

  explicit Lens(const Camera& camera) {
    const Matrix3d axes = camera_axes(camera);
    eye = camera.eye.cast<float>();
    right = axes.col(0).cast<float>();
    up = axes.col(1).cast<float>();
    back = axes.col(2).cast<float>();
    focal = static_cast<float>(camera.height / (2 * std::tan(camera.vertical_fov / 2)));
    middle_x = static_cast<float>(camera.width) / 2;
    middle_y = static_cast<float>(camera.height) / 2;
    near = static_cast<float>(camera.near);
  }
  /// Unit direction through pixel position (x, y).
  Vector3f direction(float x, float y) const {
    return (right * ((x - middle_x) / focal) - up * ((y - middle_y) / focal) - back).normalized();
  }
  float depth(const Vector3f& point) const { return -back.dot(point - eye); }
  Eigen::Vector2f pixel(const Vector3f& point) const {
    const Vector3f p = point - eye;
    const float scale = focal / std::max(-back.dot(p), 1e-9F);
    return {middle_x + right.dot(p) * scale, middle_y - up.dot(p) * scale};
  }
};

}  // namespace phiz::detail
