// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/face_frame.h"

#include <algorithm>
#include <cmath>

#include "phiz/core/error.h"

namespace phiz {

Vector3d landmark_position(const HeadTemplate& head, const std::string& name) {
  const auto found = std::find_if(head.landmarks.begin(), head.landmarks.end(),
                                  [&name](const Landmark& mark) { return mark.name == name; });
  if (found == head.landmarks.end())
    reject("head " + head.name, "the landmark " + name + " is missing", "the 68 of the usual markup are needed");
  return head.skin.V.row(found->skin_vertex);
}

FaceFrame face_frame(const HeadTemplate& head) {
  const auto at = [&head](int number) { return landmark_position(head, std::to_string(number)); };
  // Left and right folded onto the left.
  const auto both = [&at](int a, int b) {
    const Vector3d p = at(a), q = at(b);
    return Vector3d(0.5 * (std::abs(p.x()) + std::abs(q.x())), 0.5 * (p.y() + q.y()), 0.5 * (p.z() + q.z()));
  };
  FaceFrame frame;
  frame.brow = both(19, 24).y();
  frame.eyes = 0.5 * (head.left_eye_centre.y() + head.right_eye_centre.y());
  frame.stomion = both(62, 66).y();
  frame.menton = at(8).y();
  frame.nasion = at(27);
  frame.nose_tip = at(30);
  frame.inner_canthus = both(39, 42);
  frame.outer_canthus = both(36, 45);
  frame.mouth_corner = both(48, 54);
  return frame;
}

}  // namespace phiz
