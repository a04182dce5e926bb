// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/render/lights.h"

#include <cmath>

namespace phiz {

std::vector<AreaLight> studio_lights(const Camera& camera, const Eigen::AlignedBox3d& box) {
  const Matrix3d axes = camera_axes(camera);
  const double size = box.isEmpty() ? 1.0 : box.diagonal().norm();
  const Vector3d centre = box.isEmpty() ? camera.target : Vector3d(box.center());
  const auto light = [&](double azimuth, double elevation, double distance, double radius, const Vector3d& irradiance) {
    const double a = azimuth * M_PI / 180, e = elevation * M_PI / 180;  // azimuth to the camera's right
    const Vector3d direction(std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e));
    return AreaLight{centre + axes * direction * distance * size, radius * size, irradiance};
  };
  return {
      light(-44, 40, 3.0, 0.60, Vector3d(2.60, 2.50, 2.36)),  // key
      light(58, 8, 3.0, 1.00, Vector3d(0.30, 0.33, 0.38)),    // fill
      light(150, 35, 3.0, 0.70, Vector3d(1.15, 1.20, 1.30)),  // rim
  };
}

}  // namespace phiz
