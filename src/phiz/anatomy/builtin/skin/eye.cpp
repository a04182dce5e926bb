// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/skin/eye.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "phiz/core/error.h"

namespace phiz {
namespace {

constexpr double iris_radius = 0.0059, pupil_radius = 0.0018, bulge = 0.0010;  // metres

/// Angle from the optical axis per ring: pupil and limbus are among them.
std::vector<double> ring_angles(double radius, int rings) {
  const double limbus = std::asin(iris_radius / radius), pupil = std::asin(pupil_radius / radius);
  const int inner = std::max(2, rings / 10), middle = std::max(3, rings / 5), rest = rings - inner - middle;
  std::vector<double> angles;
  for (int k = 1; k <= inner; ++k) angles.push_back(pupil * k / inner);
  for (int k = 1; k <= middle; ++k) angles.push_back(pupil + (limbus - pupil) * k / middle);
  for (int k = 1; k < rest; ++k) angles.push_back(limbus + (std::numbers::pi - limbus) * k / rest);
  return angles;
}

}  // namespace

Eye build_eye(const Proportions& proportions, bool left, int rings) {
  if (rings < 12 || rings > 1000) reject("eye", "the number of rings must lie between 12 and 1000");
  const double radius = proportions.eye_radius;
  Vector3d centre = proportions.eye_centre;
  if (!left) centre.x() = -centre.x();
  const std::vector<double> angles = ring_angles(radius, rings);
  const int columns = 2 * rings, count = static_cast<int>(angles.size());
  Eye eye;
  eye.mesh.V.resize(2 + count * columns, 3);
  eye.mesh.UV.resize(eye.mesh.V.rows(), 2);
  std::vector<Eigen::RowVector3i> triangles;
  std::vector<int> part;
  const auto set = [&](int row, double angle, double around) {
    const double rho = radius * std::sin(angle);
    const double inside = angle < std::numbers::pi / 2 ? std::max(0.0, 1 - std::pow(rho / iris_radius, 2)) : 0.0;
    eye.mesh.V.row(row) = (centre + Vector3d(rho * std::cos(around), rho * std::sin(around),
                                             radius * std::cos(angle) + bulge * inside * inside))
                              .transpose();
    const double share = 0.49 * angle / std::numbers::pi;
    eye.mesh.UV.row(row) << 0.5 + share * std::cos(around), 0.5 + share * std::sin(around);
  };
  set(0, 0, 0);
  set(1, std::numbers::pi, 0);
  const auto at = [&](int ring, int column) { return 2 + ring * columns + column % columns; };
  const auto triangle = [&](int a, int b, int c, double outer_angle) {
    triangles.emplace_back(a, b, c);
    const double rho = outer_angle < std::numbers::pi / 2 ? radius * std::sin(outer_angle) : radius;
    part.push_back(static_cast<int>(rho <= pupil_radius + 1e-9  ? EyePart::pupil
                                    : rho <= iris_radius + 1e-9 ? EyePart::iris
                                                                : EyePart::sclera));
  };
  for (int r = 0; r < count; ++r)
    for (int c = 0; c < columns; ++c) set(at(r, c), angles[r], 2 * std::numbers::pi * c / columns);
  for (int c = 0; c < columns; ++c) {
    triangle(0, at(0, c), at(0, c + 1), angles[0]);
    for (int r = 0; r + 1 < count; ++r) {
      triangle(at(r, c), at(r + 1, c), at(r + 1, c + 1), angles[r + 1]);
      triangle(at(r, c), at(r + 1, c + 1), at(r, c + 1), angles[r + 1]);
    }
    triangle(at(count - 1, c), 1, at(count - 1, c + 1), std::numbers::pi);
  }
  eye.mesh.F.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t f = 0; f < triangles.size(); ++f) eye.mesh.F.row(static_cast<Eigen::Index>(f)) = triangles[f];
  eye.mesh.FUV = eye.mesh.F;
  eye.part = Eigen::Map<VectorXi>(part.data(), static_cast<Eigen::Index>(part.size()));
  return eye;
}

}  // namespace phiz
