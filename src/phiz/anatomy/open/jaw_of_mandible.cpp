// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/open/jaw_of_mandible.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace phiz {

std::array<Vector3d, 2> condyle_centres(const MatrixX3d& mandible) {
  constexpr double height = 0.006, depth = 0.020;  // metres; the coronoid process stands further in front
  const double middle = 0.5 * (mandible.col(0).minCoeff() + mandible.col(0).maxCoeff());
  std::array<Vector3d, 2> centres;
  for (const int side : {0, 1}) {
    const auto on_side = [&](Eigen::Index v) { return (mandible(v, 0) > middle) == (side == 0); };
    double back = 1e9, top = -1e9;
    for (Eigen::Index v = 0; v < mandible.rows(); ++v)
      if (on_side(v)) back = std::min(back, mandible(v, 2));
    for (Eigen::Index v = 0; v < mandible.rows(); ++v)
      if (on_side(v) && mandible(v, 2) < back + depth) top = std::max(top, mandible(v, 1));
    Vector3d low = Vector3d::Constant(1e9), high = -low;
    for (Eigen::Index v = 0; v < mandible.rows(); ++v) {
      if (!on_side(v) || mandible(v, 2) > back + depth || mandible(v, 1) < top - height) continue;
      low = low.cwiseMin(mandible.row(v).transpose());
      high = high.cwiseMax(mandible.row(v).transpose());
    }
    centres[static_cast<std::size_t>(side)] = 0.5 * (low + high);
  }
  return centres;
}

JawJoint joint_of(const std::array<Vector3d, 2>& condyles) {
  JawJoint joint;
  joint.centre = 0.5 * (condyles[0] + condyles[1]);
  joint.axis = (condyles[0] - condyles[1]).normalized();
  joint.up = (Vector3d::UnitY() - joint.axis * joint.axis.y()).normalized();
  // Opening to about 50 mm between the incisors; lateral swing; play of the condyles: sideways, down, forward.
  joint.lower << -0.03, -0.14, -0.006, -0.012, -0.004;
  joint.upper << 0.52, 0.14, 0.006, 0.004, 0.016;
  return joint;
}

JawPose fit_jaw_pose(const JawJoint& joint, const MatrixX3d& rest, const MatrixX3d& moved, double* residual) {
  const Eigen::Matrix4d T = Eigen::umeyama(rest.transpose(), moved.transpose(), false);
  // R = R_up(swing) R_axis(open), read off in the frame of the joint.
  Matrix3d frame;
  frame << joint.axis, joint.up, joint.axis.cross(joint.up);
  const Matrix3d R = frame.transpose() * T.topLeftCorner<3, 3>() * frame;
  JawPose pose = JawPose::Zero();
  pose[0] = std::atan2(-R(1, 2), R(1, 1));
  pose[1] = std::atan2(-R(2, 0), R(0, 0));
  const Eigen::Isometry3d turned = jaw_transform(joint, pose);
  const MatrixX3d placed = (rest * turned.linear().transpose()).rowwise() + turned.translation().transpose();
  pose.tail<3>() = (moved - placed).colwise().mean();
  if (residual != nullptr)
    *residual = (moved - (placed.rowwise() + pose.tail<3>().transpose())).rowwise().norm().maxCoeff();
  return pose;
}

}  // namespace phiz
