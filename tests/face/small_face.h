// SPDX-License-Identifier: GPL-3.0-or-later
/// A face in miniature for the tests: two soft lips, the upper one hanging from a skull bar, the lower one standing on
/// a mandible bar that hinges far behind, with a row of teeth, and the expressions jawOpen, pout and press.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "elasticity/blocks.h"
#include "phiz/face/face_model.h"
#include "phiz/face/performance.h"
#include "phiz/geometry/topology.h"

namespace phiz::testing {

inline HeadTemplate small_head() {
  const double gap = 4e-4;
  TetMesh lower = box({-0.020, -0.012, 0.06}, {0.020, 0, 0.068}, 9, 5, 4);
  TetMesh upper = box({-0.020, gap, 0.06}, {0.020, 0.012 + gap, 0.068}, 9, 5, 4);
  // Lips are round: their free ends fall away from the middle to all sides.
  const auto round = [](TetMesh& lip, double end, double far) {
    for (Eigen::Index v = 0; v < lip.V.rows(); ++v) {
      const double across = (lip.V(v, 2) - 0.064) / 0.004, along = lip.V(v, 0) / 0.020;
      const double share = (lip.V(v, 1) - far) / (end - far);
      lip.V(v, 1) += (far > end ? 1 : -1) * share * share * (0.003 * across * across + 0.002 * along * along);
    }
  };
  round(lower, 0, -0.012);
  round(upper, gap, 0.012 + gap);
  const int split = static_cast<int>(lower.V.rows());
  HeadTemplate head;
  head.name = "small";
  head.volume.V.resize(lower.V.rows() + upper.V.rows(), 3);
  head.volume.V << lower.V, upper.V;
  head.volume.T.resize(lower.T.rows() + upper.T.rows(), 4);
  head.volume.T << lower.T, (upper.T.array() + split).matrix();
  head.volume.region = VectorXi::Constant(head.volume.T.rows(), Tissue::flesh);
  head.carrier = VectorXi::Zero(head.volume.V.rows());
  for (Eigen::Index v = 0; v < head.carrier.size(); ++v) {
    if (head.volume.V(v, 1) < -0.0119) head.carrier[v] = static_cast<int>(Carrier::mandible);
    if (head.volume.V(v, 1) > 0.0119 + gap) head.carrier[v] = static_cast<int>(Carrier::skull);
  }
  head.skin_triangles = boundary_triangles(head.volume.T);
  std::vector<int> used(head.skin_triangles.data(), head.skin_triangles.data() + head.skin_triangles.size());
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  head.skin_vertices = Eigen::Map<VectorXi>(used.data(), static_cast<Eigen::Index>(used.size()));
  head.skin.V = head.volume.V(head.skin_vertices, Eigen::all);
  head.skin.F.resize(head.skin_triangles.rows(), 3);
  for (Eigen::Index i = 0; i < head.skin_triangles.size(); ++i)
    head.skin.F.data()[i] =
        static_cast<int>(std::lower_bound(used.begin(), used.end(), head.skin_triangles.data()[i]) - used.begin());
  SparseMatrixd identity(head.skin.V.rows(), head.skin.V.rows());
  identity.setIdentity();
  head.skin_sampling = head.skin_interpolation = identity;

  const TetMesh teeth = box({-0.02, -0.004, 0.052}, {0.02, 0.006, 0.0595}, 6, 2, 1);
  head.parts.push_back({"upperTeeth", {teeth.V, boundary_triangles(teeth.T), {}, {}}, Carrier::skull, {}});
  head.jaw.upper << 0.5, 0.2, 0.01, 0.01, 0.01;
  head.jaw.lower << -0.05, -0.2, -0.01, -0.01, -0.01;

  for (const bool of_upper : {false, true}) {
    ContactRegion region;
    region.name = of_upper ? "upperLip" : "lowerLip";
    std::vector<int> rows;
    for (Eigen::Index f = 0; f < head.skin_triangles.rows(); ++f)
      if ((head.skin_triangles(f, 0) >= split) == of_upper &&
          (head.volume.V(head.skin_triangles.row(f), 1).array()).abs().minCoeff() < 0.0095)
        rows.push_back(static_cast<int>(f));
    region.triangles = head.skin_triangles(rows, Eigen::all);
    std::vector<int> vertices(region.triangles.data(), region.triangles.data() + region.triangles.size());
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    region.vertices = Eigen::Map<VectorXi>(vertices.data(), static_cast<Eigen::Index>(vertices.size()));
    head.contact_regions.push_back(region);
  }
  head.contact_pairs = {
      {"upperLip", "lowerLip"}, {"lowerLip", "upperLip"}, {"upperLip", "upperTeeth"}, {"lowerLip", "upperTeeth"}};

  const Eigen::Index n = head.skin.V.rows();
  Expression open{"jawOpen", MatrixX3d::Zero(n, 3), JawPose::Zero()};
  open.jaw[0] = 0.3;
  const Eigen::Isometry3d jaw = jaw_transform(head.jaw, open.jaw);
  Expression pout{"mouthPucker", MatrixX3d::Zero(n, 3), JawPose::Zero()};
  Expression press{"mouthPressLeft", MatrixX3d::Zero(n, 3), JawPose::Zero()};
  for (Eigen::Index i = 0; i < n; ++i) {
    const Vector3d p = head.skin.V.row(i);
    if (used[static_cast<std::size_t>(i)] < split) open.displacement.row(i) = jaw * p - p;
    const double y = p.y() > 0.5 * gap ? p.y() - gap : -p.y();
    const double free = std::clamp(1 - y / 0.012, 0.0, 1.0);
    pout.displacement.row(i) = free * Vector3d(-0.15 * p.x(), 0, 0.003 * std::cos(60 * p.x()));
    press.displacement.row(i) = free * Vector3d(0, p.y() > 0.5 * gap ? -0.0015 : 0.0015, 0);
  }
  head.expressions = {open, pout, press};
  return head;
}

/// The three expressions in motion.
inline Performance small_performance(int frames) {
  Performance performance;
  performance.expressions = {"JawOpen", "MouthPucker", "MouthPressLeft", "browInnerUp"};
  performance.frame_rate = 30;
  performance.time = VectorXd::LinSpaced(frames, 0, (frames - 1) / 30.0);
  performance.weights.resize(frames, 4);
  performance.head = performance.left_eye = performance.right_eye = MatrixX3d::Zero(frames, 3);
  for (int f = 0; f < frames; ++f) {
    const double t = f / 30.0;
    performance.weights.row(f) << 0.5 - 0.5 * std::cos(6 * t), 0.4 + 0.4 * std::sin(4 * t),
        std::max(0.0, std::cos(6 * t)), 0.3;
    performance.head(f, 0) = 0.3 * std::sin(3 * t);
  }
  return performance;
}

/// Weights of the small face's three expressions.
inline VectorXd small_weights(double open, double pout, double press) {
  return Vector3d(open, pout, press);
}

}  // namespace phiz::testing
