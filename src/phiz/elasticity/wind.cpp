// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/wind.h"

#include <Eigen/Geometry>
#include <cmath>

#include "phiz/core/error.h"

namespace phiz {

MatrixX3d wind_forces(const MatrixX3i& triangles, const MatrixX3d& x, const MatrixX3d& velocity, const Air& air) {
  if (!x.allFinite() || !velocity.allFinite() || (velocity.rows() != 0 && velocity.rows() != x.rows()))
    reject("wind", "needs a finite position and velocity for every vertex");
  if (!air.wind.allFinite() || !(air.density >= 0 && air.drag >= 0 && std::isfinite(air.density * air.drag)))
    reject("wind", "needs a finite wind, and density and drag of 0 or more");
  if (triangles.size() > 0 && (triangles.minCoeff() < 0 || triangles.maxCoeff() >= x.rows()))
    reject("wind", "a triangle names a vertex that does not exist");
  MatrixX3d forces = MatrixX3d::Zero(x.rows(), 3);
  for (Eigen::Index f = 0; f < triangles.rows(); ++f) {
    const Vector3d a = x.row(triangles(f, 0)), b = x.row(triangles(f, 1)), c = x.row(triangles(f, 2));
    const Vector3d normal = (b - a).cross(c - a);  // 2 A n
    const double length = normal.norm();
    if (!(length > 0)) continue;
    Vector3d u = air.wind;
    if (velocity.rows() > 0)
      for (int k = 0; k < 3; ++k) u -= velocity.row(triangles(f, k)).transpose() / 3;
    const double across = normal.dot(u) / length;
    const Vector3d force = 0.25 * air.density * air.drag * std::abs(across) * across * normal;
    for (int k = 0; k < 3; ++k) forces.row(triangles(f, k)) += force.transpose() / 3;
  }
  return forces;
}

}  // namespace phiz
