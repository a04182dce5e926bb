// SPDX-License-Identifier: GPL-3.0-or-later
/// Take: the result of animating a head: positions of the drawn skin per frame, poses of the rigid parts, statistics.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "phiz/anatomy/head_template.h"
#include "phiz/elasticity/solve_statistics.h"

namespace phiz {

using MatrixX3f = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;

struct TakeFrame {
  double time = 0;  ///< seconds
  MatrixX3f skin;   ///< positions of the drawn skin in the head frame, metres
  JawPose jaw = JawPose::Zero();
  Eigen::Isometry3d head = Eigen::Isometry3d::Identity();  ///< world from head frame
  Matrix3d left_eye = Matrix3d::Identity();                ///< rotation about the eye's centre, relative to the head
  Matrix3d right_eye = Matrix3d::Identity();
  VectorXd part_weights;  ///< weights of the expressions, for parts with shapes
  MatrixX3f volume;       ///< positions of HeadTemplate::volume.V, or empty
  MatrixX3f velocity;     ///< world velocities of the same vertices, m/s; empty in static takes
  SolveStatistics statistics;
};

struct Take {
  std::string model;  ///< name of the head
  double frame_rate = 30;
  TriangleMesh skin;        ///< topology, UVs and rest positions of the drawn skin
  std::vector<Part> parts;  ///< rigid parts at rest
  JawJoint joint;
  Vector3d left_eye_centre = Vector3d::Zero();
  Vector3d right_eye_centre = Vector3d::Zero();
  std::vector<std::string> expressions;  ///< names of TakeFrame::part_weights
  std::vector<TakeFrame> frames;
  int frames_planned = 0;  ///< frames of the whole performance; more than frames.size() if interrupted
};

/// A head at rest, as a take of one frame.
Take rest_take(const HeadTemplate& head);

/// Motion of a part in one frame, world from rest.
Eigen::Isometry3d part_transform(const Take& take, const TakeFrame& frame, const Part& part);

}  // namespace phiz
