// SPDX-License-Identifier: GPL-3.0-or-later
/// FaceModel: a head with its volumetric blendshapes (Ichim 2017, chapter 5).
#pragma once

#include <string>
#include <vector>

#include "phiz/anatomy/head_template.h"

namespace phiz {

/// One volumetric blendshape: the polar parts of M = I + V per flesh tet, M = exp(log_rotation) * (I + stretch). Only
/// the tets that the shape moves are kept.
struct VolumetricShape {
  std::string name;
  JawPose jaw = JawPose::Zero();
  VectorXi tets;                                                          ///< rows of HeadTemplate::volume.T
  Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> log_rotation;  ///< rotation vector, radians
  Eigen::Matrix<float, Eigen::Dynamic, 6, Eigen::RowMajor> stretch;       ///< S - I: xx, yy, zz, xy, xz, yz
  /// Displacement of every vertex of HeadTemplate::volume in the shape's own solution, metres; the predictor of the
  /// animation solver. May be empty.
  Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> displacement;
};

struct FaceModel {
  HeadTemplate head;
  std::vector<VolumetricShape> shapes;
};

}  // namespace phiz
