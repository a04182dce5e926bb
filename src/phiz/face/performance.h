// SPDX-License-Identifier: GPL-3.0-or-later
/// Performance: what a face tracker records. Weights of named expressions, head pose and eye rotation over time.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "phiz/geometry/mesh.h"

namespace phiz {

struct Performance {
  std::vector<std::string> expressions;  ///< names of the columns of `weights` (ARKit's camelCase)
  VectorXd time;                         ///< seconds from the first frame, ascending, f entries
  MatrixXd weights;                      ///< f x expressions.size(), usually in [0, 1]
  MatrixX3d head;                        ///< f x 3: yaw, pitch, roll of the head, radians
  MatrixX3d left_eye;                    ///< f x 3: yaw, pitch, roll of the eye relative to the head, radians
  MatrixX3d right_eye;                   ///< f x 3
  double frame_rate = 60;                ///< nominal frames per second
};

/// Rotation of yaw (about +y), pitch (about +x), roll (about +z), applied as R_y R_x R_z, in the head frame. Positive
/// yaw turns to the person's left, positive pitch looks down, positive roll tips the head to the person's right
/// (right-handed rotations).
Matrix3d rotation_from_angles(const Vector3d& yaw_pitch_roll);

/// Throws phiz::Error(bad_input) when counts disagree, a value is not finite, time does not ascend, or weights or
/// angles are of a scale that suggests another unit (percent, degrees).
void validate(const Performance& performance, const std::string& where);

/// The performance at another frame rate: weights linear in time, angles along the shorter arc. frame_rate > 0.
Performance resample(const Performance& performance, double frame_rate);

}  // namespace phiz
