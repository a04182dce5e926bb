// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/face/bone_slides.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace phiz {

namespace {

constexpr double reach = 0.012;           // metres: a neighbour's weight falls to 1/e
constexpr double farthest = 0.018;        // metres
constexpr double same_side = 0.5;         // least cosine between the normals of neighbours
constexpr double usual_bend = 30;         // 1/metre: how much bones bend in general
constexpr double most_bend = 1 / 0.016;   // 1/metre
constexpr double least_roughness = 2e-4;  // metres

bool on_mandible(const HeadTemplate& head, int vertex) {
  return head.carrier[vertex] == static_cast<int>(Carrier::mandible);
}

/// Points of a bone in the frame of a vertex: distances along two tangents and above the tangent plane.
struct Neighbourhood {
  std::vector<Vector3d> points;
  std::vector<double> weights;
};

/// Bend (uu, vv, uv) in h = (uu u^2 + vv v^2) / 2 + uv u v: the likeliest for points that are off by `roughness` and
/// bones that bend by `usual_bend`, the points together counting as one sample.
Vector3d fit_bend(const Neighbourhood& near, double roughness) {
  Matrix3d A = Matrix3d::Zero();
  Vector3d b = Vector3d::Zero();
  double total = 0;
  for (std::size_t i = 0; i < near.points.size(); ++i) {
    const double u = near.points[i].x(), v = near.points[i].y(), w = near.weights[i];
    const Vector3d row(0.5 * u * u, 0.5 * v * v, u * v);
    A += w * row * row.transpose();
    b += w * near.points[i].z() * row;
    total += w;
  }
  const double damping = roughness * roughness / (usual_bend * usual_bend);
  A += total * damping * Vector3d(1, 1, 2).asDiagonal().toDenseMatrix();
  return A.ldlt().solve(b);
}

double roughness_of(const Neighbourhood& near, const Vector3d& bend) {
  double sum = 0, total = 0;
  for (std::size_t i = 0; i < near.points.size(); ++i) {
    const double u = near.points[i].x(), v = near.points[i].y();
    const double off = near.points[i].z() - 0.5 * (bend[0] * u * u + bend[1] * v * v) - bend[2] * u * v;
    sum += near.weights[i] * off * off;
    total += near.weights[i];
  }
  return std::max(least_roughness, std::sqrt(sum / total));
}

/// The bend at row `at` of the attachments, 3 x 3.
Matrix3d bend_at(const HeadTemplate& head, Eigen::Index at) {
  const Attachments& all = head.attachments;
  const Vector3d point = head.volume.V.row(all.vertices[at]), normal = all.normals.row(at);
  const Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
  Neighbourhood near;
  for (Eigen::Index i = 0; i < all.vertices.size(); ++i) {
    const Vector3d d = head.volume.V.row(all.vertices[i]).transpose() - point;
    if (i == at || d.squaredNorm() > farthest * farthest || all.normals.row(i).dot(normal) < same_side ||
        head.carrier[all.vertices[i]] != head.carrier[all.vertices[at]])
      continue;
    near.points.emplace_back(d.dot(u), d.dot(v), d.dot(normal));
    near.weights.push_back(std::exp(-d.squaredNorm() / (reach * reach)));
  }
  if (near.points.empty()) return Matrix3d::Zero();
  Vector3d bend = fit_bend(near, least_roughness);
  bend = fit_bend(near, roughness_of(near, bend));
  Eigen::Matrix2d tangent;
  tangent << bend[0], bend[2], bend[2], bend[1];
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(tangent);
  const Eigen::Vector2d bounded = eigen.eigenvalues().cwiseMax(-most_bend).cwiseMin(most_bend);
  Eigen::Matrix<double, 3, 2> axes;
  axes << u, v;
  axes *= eigen.eigenvectors();
  return axes * bounded.asDiagonal() * axes.transpose();
}

}  // namespace

std::vector<Slide> bone_slides(const HeadTemplate& head) {
  const Attachments& all = head.attachments;
  std::vector<Slide> slides;
  for (Eigen::Index i = 0; i < all.vertices.size(); ++i)
    if (all.hold[i] == static_cast<int>(Hold::slide))
      slides.push_back({all.vertices[i], head.volume.V.row(all.vertices[i]), all.normals.row(i), bend_at(head, i)});
  return slides;
}

Slide placed(const HeadTemplate& head, const Slide& rest, const JawPose& pose) {
  if (!on_mandible(head, rest.vertex)) return rest;
  const Eigen::Isometry3d jaw = jaw_transform(head.jaw, pose);
  const Matrix3d R = jaw.linear();
  return {rest.vertex, jaw * rest.point, (R * rest.normal).normalized(), R * rest.bend * R.transpose()};
}

SlideRate slide_rate(const HeadTemplate& head, const Slide& rest, const JawPose& pose, const Vector3d& x) {
  if (!on_mandible(head, rest.vertex)) return {RowVector5d::Zero(), Matrix3x5d::Zero()};
  // The height is h0(T^-1 x), its gradient g = R g0(T^-1 x): what moves is the point of the jaw that is at x.
  const Eigen::Isometry3d to_rest = jaw_transform(head.jaw, pose).inverse();
  const Slide now = placed(head, rest, pose);
  const Vector3d at = to_rest * x, g = now.gradient(x);
  const Matrix3x5d moves = jaw_jacobian(head.jaw, pose, at);
  const Matrix3x5d turns = jaw_jacobian(head.jaw, pose, at + to_rest.linear() * g) - moves;
  return {-g.transpose() * moves, turns + now.bend * moves};
}

}  // namespace phiz
