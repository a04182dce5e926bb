// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>

#include "phiz/anatomy/skin_ride.h"
#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/geometry/spatial_query.h"
#include "phiz/render/head_quantities.h"
#include "phiz/render/head_surfaces.h"

namespace phiz {

namespace {

constexpr double average_eye_distance = 0.063;  // metres

MatrixX3d deformed_part(const Take& take, const TakeFrame& frame, const Part& part) {
  MatrixX3d V;
  if (part.carrier == Carrier::flesh) return SkinRide(take.skin, part.mesh)(frame.skin.cast<double>());
  if (part.shapes.empty()) return V;
  V = part.mesh.V;
  for (std::size_t i = 0; i < take.expressions.size(); ++i) {
    const auto shape = part.shapes.find(take.expressions[i]);
    if (shape != part.shapes.end() && static_cast<Eigen::Index>(i) < frame.part_weights.size() &&
        shape->second.rows() == V.rows())
      V += frame.part_weights[static_cast<Eigen::Index>(i)] * shape->second;
  }
  return V;
}

/// Adds how deep points lie inside a closed surface that has moved.
void add_depth(const Part& part, const Eigen::Isometry3d& motion, const MatrixX3f& points, VectorXd& depth) {
  if (part.mesh.F.rows() == 0) return;
  const SurfaceQuery query(part.mesh);
  Eigen::AlignedBox3d box;
  for (Eigen::Index i = 0; i < part.mesh.V.rows(); ++i) box.extend(Vector3d(part.mesh.V.row(i)));
  const Eigen::Isometry3d back = motion.inverse();
  parallel_for(points.rows(), [&](std::ptrdiff_t i) {
    const Vector3d p = back * Vector3d(points.row(i).cast<double>());
    if (box.contains(p)) depth[i] = std::max(depth[i], -1000 * query.signed_distance(p));
  });
}

}  // namespace

VectorXd teeth_penetration(const Take& take, const TakeFrame& frame) {
  VectorXd depth = VectorXd::Zero(frame.skin.rows());
  for (const Part& part : take.parts)
    if (part.name.find("eeth") != std::string::npos)
      add_depth(part, frame.head.inverse() * part_transform(take, frame, part), frame.skin, depth);
  return depth;
}

Scene head_scene(const Take& take, const TakeFrame& frame, const HeadViewOptions& options, const HeadTemplate* head) {
  if (frame.skin.rows() != take.skin.V.rows())
    reject("take", fmt::format("a frame has {} skin vertices, the skin {}", frame.skin.rows(), take.skin.V.rows()),
           "animate again");
  if (head != nullptr && head->skin.V.rows() != take.skin.V.rows())
    reject("take",
           fmt::format("it was made with a head of {} skin vertices, this one has {}", take.skin.V.rows(),
                       head->skin.V.rows()),
           "give the head that the take was made with");
  detail::PosedHead posed;
  posed.skin = &take.skin;
  posed.skin_now = frame.skin.cast<double>();
  posed.parts = &take.parts;
  posed.head = head;
  posed.left_eye = take.left_eye_centre;
  posed.right_eye = take.right_eye_centre;
  if (head != nullptr && frame.volume.rows() == head->volume.V.rows()) posed.volume_now = frame.volume.cast<double>();
  for (const Part& part : take.parts) {
    posed.motion.push_back(frame.head.inverse() * part_transform(take, frame, part));
    posed.part_now.push_back(deformed_part(take, frame, part));
  }
  Scene scene = detail::build_scene(posed, options);
  if (!options.still_head)
    for (Surface& s : scene.surfaces) s.transform = frame.head * s.transform;
  return scene;
}

FacePoints face_points(const Take& take) {
  FacePoints face = guess_face_points(take.skin.V);
  if ((take.left_eye_centre - take.right_eye_centre).norm() > 0) {
    face.left_eye = take.left_eye_centre;
    face.right_eye = take.right_eye_centre;
    face.unit = (face.left_eye - face.right_eye).norm() / average_eye_distance;
  }
  return face;
}

Camera take_camera(const Take& take, View view, int width, int height) {
  if (is_close_up(view) || take.frames.empty()) return frame_view(view, take.skin.V, face_points(take), width, height);
  // Every 16th vertex in every pose of the head, so that the head stays in the picture and does not wobble with the
  // framing.
  std::vector<Vector3d> reached;
  for (Eigen::Index i = 0; i < take.skin.V.rows(); i += 16)
    for (const TakeFrame& frame : take.frames)
      reached.emplace_back(frame.head * Vector3d(frame.skin.row(i).cast<double>()));
  MatrixX3d points(static_cast<Eigen::Index>(reached.size()), 3);
  for (std::size_t i = 0; i < reached.size(); ++i) points.row(static_cast<Eigen::Index>(i)) = reached[i].transpose();
  return frame_view(view, points, face_points(take), width, height);
}

}  // namespace phiz
