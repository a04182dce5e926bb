// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/jaw.h"

namespace phiz {

Eigen::Isometry3d jaw_transform(const JawJoint& joint, const JawPose& pose) {
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.translate(joint.centre + pose.tail<3>());
  transform.rotate(Eigen::AngleAxisd(pose[1], joint.up));
  transform.rotate(Eigen::AngleAxisd(pose[0], joint.axis));
  transform.translate(-joint.centre);
  return transform;
}

Eigen::Matrix<double, 3, 5> jaw_jacobian(const JawJoint& joint, const JawPose& pose, const Vector3d& point) {
  const Eigen::AngleAxisd swing(pose[1], joint.up);
  const Vector3d opened = Eigen::AngleAxisd(pose[0], joint.axis) * (point - joint.centre);
  Eigen::Matrix<double, 3, 5> jacobian;
  jacobian.col(0) = swing * joint.axis.cross(opened);
  jacobian.col(1) = joint.up.cross(swing * opened);
  jacobian.rightCols<3>().setIdentity();
  return jacobian;
}

}  // namespace phiz
