// SPDX-License-Identifier: GPL-3.0-or-later
/// Blending of volumetric blendshapes into target deformation gradients (Ichim 2017, section 5.3.4).
#pragma once

#include <memory>
#include <vector>

#include "phiz/elasticity/element_kernel.h"
#include "phiz/face/face_model.h"

namespace phiz {

/// Shapes of less weight than this take no part in a blend.
inline constexpr double least_blend_weight = 1e-5;

/// Jaw pose of expression weights (one per shape): sum w_m b_m within the limits of the joint.
JawPose blend_jaw(const FaceModel& model, const VectorXd& weights);

/// Polar blend of one tet: R = exp(sum w_m log R_m), S = I + sum w_m (S_m - I), returns R S. Rows of `log_rotations`
/// and `stretches` per shape.
Matrix3d polar_blend(const MatrixX3d& log_rotations, const Eigen::Matrix<double, Eigen::Dynamic, 6>& stretches,
                     const VectorXd& weights);

/// Linear blend of one tet, I + sum w_m (M_m - I), for comparison: it loses volume under rotation.
Matrix3d linear_blend(const MatrixX3d& log_rotations, const Eigen::Matrix<double, Eigen::Dynamic, 6>& stretches,
                      const VectorXd& weights);

/// exp of a rotation vector.
Matrix3d rotation_exponential(const Vector3d& v);

/// Logarithm of the change of volume that the volume term excuses in a shape whose gradient has determinant `det`: none
/// within about 15 %, which the solver corrects, and the excess beyond, where a sculpt folds or crushes flesh and
/// insisting on its volume would only make it buckle.
double excused_volume(double det);

/// All tets at once: the shapes rearranged by blocks of tets in the order of an ElementBlocks.
class TargetBlender {
 public:
  /// `soft`: rows of volume.T that are simulated; `slot`: kernel slot of each of them.
  TargetBlender(const FaceModel& model, const VectorXi& soft, const std::vector<std::ptrdiff_t>& slot);
  ~TargetBlender();
  TargetBlender(TargetBlender&&) noexcept;
  TargetBlender& operator=(TargetBlender&&) noexcept;

  /// Writes the targets of all tets for weights per shape: gradient, stretch, and the volume goal exp(sum w_m
  /// excused_m). Weights below 1e-5 count as none.
  void blend(const VectorXd& weights, ElementBlocks<float>& elements) const;

 private:
  struct Table;
  std::unique_ptr<Table> table_;
};

}  // namespace phiz
