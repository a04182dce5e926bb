// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/render/head_view.h"

#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "phiz/anatomy/skin_ride.h"
#include "phiz/core/error.h"
#include "phiz/render/head_surfaces.h"

namespace phiz {

namespace {

constexpr std::array<std::pair<std::string_view, HeadStyle>, 11> styles = {{{"clay", HeadStyle::clay},
                                                                            {"skin", HeadStyle::skin},
                                                                            {"wireframe", HeadStyle::wireframe},
                                                                            {"anatomy", HeadStyle::anatomy},
                                                                            {"bones", HeadStyle::bones},
                                                                            {"cutaway", HeadStyle::cutaway},
                                                                            {"muscles", HeadStyle::muscles},
                                                                            {"fibres", HeadStyle::fibres},
                                                                            {"attachments", HeadStyle::attachments},
                                                                            {"contacts", HeadStyle::contacts},
                                                                            {"heat", HeadStyle::heat}}};

constexpr double average_eye_distance = 0.063;  // metres

/// Adds the eye rotation of an eyeLook* expression.
void look(const std::string& name, double weight, Vector2d& left, Vector2d& right) {
  if (name.rfind("eyeLook", 0) != 0) return;
  constexpr double up_down = 25 * M_PI / 180, sideways = 30 * M_PI / 180;
  const bool is_left = name.size() > 4 && name.substr(name.size() - 4) == "Left";
  Vector2d& eye = is_left ? left : right;
  const auto direction = [&](const char* word) { return name.find(word) != std::string::npos; };
  if (direction("Up")) eye.y() -= weight * up_down;
  if (direction("Down")) eye.y() += weight * up_down;
  if (direction("Out")) eye.x() += weight * (is_left ? sideways : -sideways);
  if (direction("LookIn")) eye.x() += weight * (is_left ? -sideways : sideways);
}

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
  posed.head = &head;
  posed.volume_now = head.volume.V;
  posed.left_eye = head.left_eye_centre;
  posed.right_eye = head.right_eye_centre;
  JawPose jaw = JawPose::Zero();
  Vector2d left_look = Vector2d::Zero(), right_look = Vector2d::Zero();  // yaw to the person's left, pitch down
  for (const auto& [name, weight] : options.expressions) {
    const Expression* expression = find_expression(head, name);
    if (expression == nullptr)
      throw Error(ErrorKind::usage, head.name + " has no expression '" + name + "'; phiz inspect lists them");
    posed.skin_now += weight * expression->displacement;
    jaw += weight * expression->jaw;
    look(name, weight, left_look, right_look);
  }
  const auto turned = [](const Vector3d& centre, const Vector2d& angles) -> Eigen::Isometry3d {
    return Eigen::Translation3d(centre) * Eigen::AngleAxisd(angles.x(), Vector3d::UnitY()) *
           Eigen::AngleAxisd(angles.y(), Vector3d::UnitX()) * Eigen::Translation3d(-centre);
  };
  for (const Part& part : head.parts) {
    posed.motion.push_back(part.carrier == Carrier::mandible    ? jaw_transform(head.jaw, jaw)
                           : part.carrier == Carrier::left_eye  ? turned(head.left_eye_centre, left_look)
                           : part.carrier == Carrier::right_eye ? turned(head.right_eye_centre, right_look)
                                                                : Eigen::Isometry3d::Identity());
    MatrixX3d deformed;
    for (const auto& [name, weight] : options.expressions) {
      const auto shape = part.shapes.find(name);
      if (shape == part.shapes.end() || shape->second.rows() != part.mesh.V.rows()) continue;
      if (deformed.rows() == 0) deformed = part.mesh.V;
      deformed += weight * shape->second;
    }
    if (part.carrier == Carrier::flesh) deformed = SkinRide(head.skin, part.mesh)(posed.skin_now);
    posed.part_now.push_back(std::move(deformed));
  }
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

bool without_skin(const HeadViewOptions& options) {
  const HeadStyle s = options.style;
  return s == HeadStyle::bones || (!options.peel && (s == HeadStyle::muscles || s == HeadStyle::attachments));
}

Camera head_camera(const HeadTemplate& head, const HeadViewOptions& options, View view, int width, int height) {
  if (!without_skin(options)) return head_camera(head, view, width, height);
  const MatrixX3d points = world_points(head_scene(head, options));
  return frame_view(view, points.rows() > 0 ? points : head.skin.V, face_points(head), width, height);
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
