// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/render/camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "phiz/core/error.h"

namespace phiz {

namespace {

constexpr double portrait_fov = 0.28;  // 24 mm of film behind an 85 mm lens

struct ViewSpec {
  View view;
  std::string_view name;
  double yaw, pitch;  // degrees: towards the person's left, upwards
};

constexpr std::array<ViewSpec, 15> view_specs = {{
    {View::front, "front", 0, 0},
    {View::three_quarter, "three-quarter", 38, 4},
    {View::three_quarter_right, "three-quarter-right", -38, 4},
    {View::side, "side", 90, 0},
    {View::side_right, "side-right", -90, 0},
    {View::back, "back", 180, 0},
    {View::top, "top", 0, 89},
    {View::below, "below", 0, -50},
    {View::face, "face", 0, 0},
    {View::mouth, "mouth", 14, 2},
    {View::left_eye, "left-eye", 12, 3},
    {View::right_eye, "right-eye", -12, 3},
    {View::eyes, "eyes", 0, 2},
    {View::nose, "nose", 24, -6},
    {View::ear, "ear", 82, 3},
}};

const ViewSpec& spec_of(View view) {
  return *std::find_if(view_specs.begin(), view_specs.end(), [&](const ViewSpec& s) { return s.view == view; });
}

/// Unit vector from the head towards the camera.
Vector3d towards_camera(const ViewSpec& spec) {
  const double yaw = spec.yaw * M_PI / 180, pitch = spec.pitch * M_PI / 180;
  return {std::sin(yaw) * std::cos(pitch), std::sin(pitch), std::cos(yaw) * std::cos(pitch)};
}

Camera look_at(const Vector3d& target, const Vector3d& towards, double visible_height, int width, int height) {
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.vertical_fov = portrait_fov;
  camera.target = target;
  // A narrow picture must still show `visible_height` across.
  const double needed = visible_height * std::max(1.0, static_cast<double>(height) / width);
  camera.eye = target + towards * (needed / 2 / std::tan(portrait_fov / 2));
  return camera;
}

}  // namespace

Matrix3d camera_axes(const Camera& camera) {
  const Vector3d back = camera.eye - camera.target;
  const Vector3d right = camera.up.cross(back);
  if (!(back.allFinite() && right.allFinite() && back.norm() > 0 && right.norm() > 1e-12 * back.norm()) ||
      camera.width < 1 || camera.height < 1 || !(camera.vertical_fov > 0 && camera.vertical_fov < M_PI))
    reject("camera", "it looks nowhere (eye on target, up along the viewing axis, empty picture or impossible angle)",
           "give a distinct eye and target, an up vector across the view and a size of at least 1 x 1");
  Matrix3d axes;
  axes.col(0) = right.normalized();
  axes.col(2) = back.normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

Vector3d project(const Camera& camera, const Vector3d& point) {
  const Vector3d p = camera_axes(camera).transpose() * (point - camera.eye);
  const double depth = -p.z();
  const double scale = camera.height / (2 * std::tan(camera.vertical_fov / 2)) / depth;
  return {camera.width / 2.0 + p.x() * scale, camera.height / 2.0 - p.y() * scale, depth};
}

FacePoints guess_face_points(const MatrixX3d& points) {
  FacePoints face;
  if (points.rows() == 0) {
    face.left_eye = face.right_eye = face.nose_tip = face.mouth = face.left_ear = face.chin = Vector3d::Zero();
    return face;
  }
  const Vector3d low = points.colwise().minCoeff(), high = points.colwise().maxCoeff();
  const double middle = (low.x() + high.x()) / 2, half = (high.x() - low.x()) / 2;
  double foremost = -std::numeric_limits<double>::infinity();
  Vector3d tip = (low + high) / 2;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Vector3d p = points.row(i);
    if (std::abs(p.x() - middle) < 0.2 * half && p.y() > low.y() + 0.25 * (high.y() - low.y()) && p.z() > foremost) {
      foremost = p.z();
      tip = p;
    }
  }
  double widest = 0;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    if (points(i, 1) > tip.y()) widest = std::max(widest, std::abs(points(i, 0) - middle));
  // An average adult: half the width over the ears 0.078 m; offsets from the tip of the nose of the same adult.
  const double unit = std::max(widest, 1e-9) / 0.078;
  tip.x() = middle;
  face.unit = unit;
  face.nose_tip = tip;
  face.left_eye = tip + unit * Vector3d(0.0315, 0.030, -0.036);
  face.right_eye = tip + unit * Vector3d(-0.0315, 0.030, -0.036);
  face.mouth = tip + unit * Vector3d(0, -0.034, -0.015);
  face.left_ear = tip + unit * Vector3d(0.075, 0.005, -0.115);
  face.chin = tip + unit * Vector3d(0, -0.075, -0.025);
  return face;
}

std::string_view view_name(View view) {
  return spec_of(view).name;
}

View view_from_name(std::string_view name) {
  std::string known;
  for (const ViewSpec& s : view_specs) {
    if (s.name == name) return s.view;
    known += known.empty() ? "" : ", ";
    known += s.name;
  }
  throw Error(ErrorKind::usage, "there is no view '" + std::string(name) + "'; the views are " + known);
}

const std::vector<View>& all_views() {
  static const std::vector<View> views = [] {
    std::vector<View> v;
    v.reserve(std::size(view_specs));
    for (const ViewSpec& s : view_specs) v.push_back(s.view);
    return v;
  }();
  return views;
}

Camera frame_points(const MatrixX3d& points, const Vector3d& direction, const Vector3d& up, int width, int height,
                    double margin) {
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.up = up;
  camera.vertical_fov = portrait_fov;
  if (points.rows() == 0) return camera;
  const Vector3d low = points.colwise().minCoeff(), high = points.colwise().maxCoeff();
  const Vector3d centre = (low + high) / 2;
  const double size = std::max((high - low).norm(), 1e-9);
  const double tan_y = std::tan(portrait_fov / 2) * (1 - 2 * margin);
  const double tan_x = std::tan(portrait_fov / 2) * (1 - 2 * margin) * width / height;
  camera.target = centre;
  camera.eye = centre - direction.normalized() * size / tan_y;
  const Matrix3d axes = camera_axes(camera);
  const MatrixX3d local = (points.rowwise() - centre.transpose()) * axes;  // right, up, towards the camera
  // Fit by planes: a point is inside when |offset| <= tan * (distance - z), for either side of each direction.
  const double right = (local.col(0) + tan_x * local.col(2)).maxCoeff();
  const double left = (-local.col(0) + tan_x * local.col(2)).maxCoeff();
  const double top = (local.col(1) + tan_y * local.col(2)).maxCoeff();
  const double bottom = (-local.col(1) + tan_y * local.col(2)).maxCoeff();
  const double distance = std::max((right + left) / (2 * tan_x), (top + bottom) / (2 * tan_y));
  const Vector3d shift = axes.col(0) * (right - left) / 2 + axes.col(1) * (top - bottom) / 2;
  camera.target = centre + shift;
  camera.eye = camera.target + axes.col(2) * distance;
  return camera;
}

Camera frame_view(View view, const MatrixX3d& points, const FacePoints& face, int width, int height) {
  const ViewSpec& spec = spec_of(view);
  const Vector3d towards = towards_camera(spec);
  const double unit = face.unit;
  switch (view) {
    case View::face: {
      const Vector3d middle = 0.31 * (face.left_eye + face.right_eye) + 0.38 * face.chin;
      return look_at(middle, towards, 0.205 * unit, width, height);
    }
    case View::mouth:
      return look_at(face.mouth, towards, 0.075 * unit, width, height);
    case View::left_eye:
      return look_at(face.left_eye, towards, 0.060 * unit, width, height);
    case View::right_eye:
      return look_at(face.right_eye, towards, 0.060 * unit, width, height);
    case View::eyes:
      return look_at((face.left_eye + face.right_eye) / 2, towards, 0.13 * unit, width, height);
    case View::nose:
      return look_at(face.nose_tip + unit * Vector3d(0.003, 0.012, -0.01), towards, 0.080 * unit, width, height);
    case View::ear:
      return look_at(face.left_ear, towards, 0.095 * unit, width, height);
    default:
      break;
  }
  const Vector3d up = view == View::top ? Vector3d(0, 0, -1) : Vector3d::UnitY();
  return frame_points(points, -towards, up, width, height);
}

}  // namespace phiz
