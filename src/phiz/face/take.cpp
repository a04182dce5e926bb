// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/face/take.h"

namespace phiz {

namespace {

Eigen::Isometry3d turn_about(const Vector3d& centre, const Matrix3d& rotation) {
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() = rotation;
  transform.translation() = centre - rotation * centre;
  return transform;
}

}  // namespace

Eigen::Isometry3d part_transform(const Take& take, const TakeFrame& frame, const Part& part) {
  switch (part.carrier) {
    case Carrier::mandible:
      return frame.head * jaw_transform(take.joint, frame.jaw);
    case Carrier::left_eye:
      return frame.head * turn_about(take.left_eye_centre, frame.left_eye);
    case Carrier::right_eye:
      return frame.head * turn_about(take.right_eye_centre, frame.right_eye);
    case Carrier::flesh:
    case Carrier::skull:
      break;
  }
  return frame.head;
}

}  // namespace phiz
