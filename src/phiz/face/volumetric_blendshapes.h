// SPDX-License-Identifier: GPL-3.0-or-later
/// Volumetric blendshapes: the sculpted skin shapes of a head carried into its flesh (Ichim 2017, section 5.3.2 with
/// the sculpted skin in place of a scan).
#pragma once

#include <functional>

#include "phiz/elasticity/solve_statistics.h"
#include "phiz/face/face_model.h"

namespace phiz {

struct BlendshapeOptions {
  double shape = 1;      ///< weight of as-rigid-as-possible elasticity (mu of eq. 5.6, 5.7)
  double volume = 50;    ///< weight of the volume term (lambda); the source's ratio is lambda = 10 mu
  double transfer = 10;  ///< weight of the transferred skin gradients in the first solve (eq. 5.5)
  double hold =
      60;  ///< pull of the sculpted skin: hold * stiffness per metre of skin distance and millimetre, see .cpp
  double inner_hold = 0.004;     ///< share of it on skin that is not seen: the mouth's bag
  double lid_hold = 10;          ///< multiple of it beside the eyes: lids unfold more than flesh of their volume would
  int max_iterations = 150;      ///< of each of the two solves
  double step_tolerance = 2e-6;  ///< metres
  double least_strain = 2e-4;    ///< tets whose rotation and stretch stay below this are not kept
  std::function<void(const std::string& name, const SolveStatistics&)> report;  ///< told about each shape, when set
};

/// Solves every expression of the head for the whole flesh: bones placed by the expression's jaw pose, skin gradients
/// transferred to the tets below (eq. 5.5, 5.6), then skin held to the sculpted shape; the deformation gradients of the
/// result are the shape. mouthClose is solved on top of jawOpen, for which it is made, and stored as the difference.
/// Vertices that move with the skull do not move. Throws phiz::Error for heads that cannot be
/// solved.
FaceModel build_volumetric_blendshapes(HeadTemplate head, const BlendshapeOptions& options = {});

/// Polar parts of deformation gradients as they are stored: F = exp(log_rotation) (I + stretch).
Vector3d rotation_logarithm(const Matrix3d& R);
VolumetricShape shape_of_gradients(const std::string& name, const JawPose& jaw, const VectorXi& tets,
                                   const std::vector<Matrix3d>& gradients, double least_strain);

}  // namespace phiz
