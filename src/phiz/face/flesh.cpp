// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/face/flesh.h"

#include <algorithm>
#include <vector>

#include "phiz/core/error.h"

namespace phiz {

namespace {

bool moves_with(const HeadTemplate& head, Eigen::Index vertex, Carrier carrier) {
  return head.carrier[vertex] == static_cast<int>(carrier);
}

}  // namespace

VectorXi soft_tets(const HeadTemplate& head) {
  std::vector<int> rows;
  for (Eigen::Index t = 0; t < head.volume.T.rows(); ++t) {
    if (head.volume.region[t] != Tissue::flesh) continue;
    bool free = false;
    for (int c = 0; c < 4; ++c) free = free || moves_with(head, head.volume.T(t, c), Carrier::flesh);
    if (free) rows.push_back(static_cast<int>(t));
  }
  if (rows.empty()) reject(head.name, "has no flesh that can move");
  return Eigen::Map<const VectorXi>(rows.data(), static_cast<Eigen::Index>(rows.size()));
}

ElasticBody flesh_body(const HeadTemplate& head, const VectorXi& soft, const TermWeights& weights, double stiffness) {
  ElasticBody body;
  body.rest = head.volume.V;
  body.tets = head.volume.T(soft, Eigen::all);
  body.fixed.resize(static_cast<std::size_t>(body.rest.rows()));
  for (Eigen::Index v = 0; v < body.rest.rows(); ++v)
    body.fixed[static_cast<std::size_t>(v)] = !moves_with(head, v, Carrier::flesh);
  body.stiffness = VectorXd::Constant(soft.size(), stiffness);
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
