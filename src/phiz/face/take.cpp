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

Take rest_take(const HeadTemplate& head) {
  Take take;
  take.model = head.name;
  take.skin = head.skin;
  take.parts = head.parts;
  take.joint = head.jaw;
  take.left_eye_centre = head.left_eye_centre;
  take.right_eye_centre = head.right_eye_centre;
  TakeFrame frame;
  frame.skin = head.skin.V.cast<float>();
  frame.volume = head.volume.V.cast<float>();
  frame.statistics.converged = true;
  take.frames.push_back(frame);
  take.frames_planned = 1;
  return take;
}

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
