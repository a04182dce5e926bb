// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/render/head_view.h"

#include <array>
#include <string>
#include <utility>

#include "phiz/core/error.h"
#include "phiz/render/head_surfaces.h"

namespace phiz {

namespace {

constexpr std::array<std::pair<std::string_view, HeadStyle>, 7> styles = {{{"clay", HeadStyle::clay},
                                                                           {"skin", HeadStyle::skin},
                                                                           {"wireframe", HeadStyle::wireframe},
                                                                           {"anatomy", HeadStyle::anatomy},
                                                                           {"bones", HeadStyle::bones},
                                                                           {"cutaway", HeadStyle::cutaway},
                                                                           {"heat", HeadStyle::heat}}};

constexpr double average_eye_distance = 0.063;  // metres

}  // namespace

HeadStyle head_style(std::string_view name) {
  std::string known;
  for (const auto& [style_name, style] : styles) {
    if (style_name == name) return style;
    known += (known.empty() ? "" : ", ") + std::string(style_name);
  }
  throw Error(ErrorKind::usage, "there is no style '" + std::string(name) + "'; the styles are " + known);
}

Scene head_scene(const HeadTemplate& head, const HeadViewOptions& options) {
  detail::PosedHead posed;
  posed.skin = &head.skin;
  posed.skin_now = head.skin.V;
  posed.parts = &head.parts;
  posed.motion.assign(head.parts.size(), Eigen::Isometry3d::Identity());
  posed.head = &head;
  posed.volume_now = head.volume.V;
  posed.left_eye = head.left_eye_centre;
  posed.right_eye = head.right_eye_centre;
  return detail::build_scene(posed, options);
}

FacePoints face_points(const HeadTemplate& head) {
  FacePoints face = guess_face_points(head.skin.V);
  const auto landmark = [&](std::string_view name, Vector3d& place) {
    for (const Landmark& l : head.landmarks)
      if (l.name == name && l.skin_vertex >= 0 && l.skin_vertex < head.skin.V.rows())
        place = head.skin.V.row(l.skin_vertex);
  };
  if ((head.left_eye_centre - head.right_eye_centre).norm() > 0) {
    face.left_eye = head.left_eye_centre;
    face.right_eye = head.right_eye_centre;
    face.unit = (face.left_eye - face.right_eye).norm() / average_eye_distance;
  }
  landmark("30", face.nose_tip);
  landmark("8", face.chin);
  Vector3d upper = face.mouth, lower = face.mouth;
  landmark("62", upper);
  landmark("66", lower);
  face.mouth = (upper + lower) / 2;
  landmark("leftTragion", face.left_ear);
  return face;
}

Camera head_camera(const HeadTemplate& head, View view, int width, int height) {
  return frame_view(view, head.skin.V, face_points(head), width, height);
}

bool is_close_up(View view) {
  switch (view) {
    case View::face:
    case View::mouth:
    case View::left_eye:
    case View::right_eye:
    case View::eyes:
    case View::nose:
    case View::ear:
      return true;
    default:
      return false;
  }
}

}  // namespace phiz
