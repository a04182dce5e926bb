// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/face/flesh.h"

#include <algorithm>

#include "phiz/geometry/tetrahedralise.h"

namespace phiz {

namespace {

// Flat tets resist by their small height, not by their flesh.
constexpr double flat_ratio = 0.1;    ///< radius ratio below which a tet is softened
constexpr double least_share = 0.02;  ///< of the stiffness

bool moves_with(const HeadTemplate& head, Eigen::Index vertex, Carrier carrier) {
  return head.carrier[vertex] == static_cast<int>(carrier);
}

}  // namespace

VectorXd flat_softening(const MatrixX3d& V, const MatrixX4i& T) {
  VectorXd share(T.rows());
  for (Eigen::Index t = 0; t < T.rows(); ++t) {
    const auto corner = [&](int k) { return Vector3d(V.row(T(t, k))); };
    const double ratio = radius_ratio(corner(0), corner(1), corner(2), corner(3));
    share[t] = std::clamp(ratio / flat_ratio, least_share, 1.0);
  }
  return share;
}

ElasticBody flesh_body(const HeadTemplate& head, const VectorXi& soft, const TermWeights& weights, double stiffness) {
  ElasticBody body;
  body.rest = head.volume.V;
  body.tets = head.volume.T(soft, Eigen::all);
  body.fixed.resize(static_cast<std::size_t>(body.rest.rows()));
  for (Eigen::Index v = 0; v < body.rest.rows(); ++v)
    body.fixed[static_cast<std::size_t>(v)] = !moves_with(head, v, Carrier::flesh);
  body.stiffness = stiffness * flat_softening(body.rest, body.tets);
  body.weights = weights;
  return body;
}

void place_bones(const HeadTemplate& head, const JawPose& pose, MatrixX3d& x) {
  const Eigen::Isometry3d jaw = jaw_transform(head.jaw, pose);
  for (Eigen::Index v = 0; v < x.rows(); ++v) {
    if (moves_with(head, v, Carrier::flesh)) continue;
    const Vector3d rest = head.volume.V.row(v);
    x.row(v) = moves_with(head, v, Carrier::mandible) ? Vector3d(jaw * rest) : rest;
  }
}

JawPose clamp_to_limits(const JawJoint& joint, const JawPose& pose) {
  return pose.cwiseMax(joint.lower).cwiseMin(joint.upper);
}

VectorXd jaw_share(const HeadTemplate& head, const VectorXi& soft) {
  // One coordinate of a purely quadratic body, whose single step is the harmonic solution.
  ProjectiveDynamics harmonic(flesh_body(head, soft, {1, 0, 0}, 1.0));
  for (Eigen::Index t = 0; t < soft.size(); ++t) harmonic.set_target(t, Matrix3d::Zero(), Matrix3d::Identity());
  MatrixX3d share = MatrixX3d::Zero(head.volume.V.rows(), 3);
  for (Eigen::Index v = 0; v < share.rows(); ++v)
    if (moves_with(head, v, Carrier::mandible)) share(v, 0) = 1;
  SolveOptions linear;
  linear.history = 0;
  linear.max_iterations = 2;
  linear.longest_step = 10;
  harmonic.solve(share, linear);
  return share.col(0).cwiseMax(0.0).cwiseMin(1.0);
}

}  // namespace phiz
