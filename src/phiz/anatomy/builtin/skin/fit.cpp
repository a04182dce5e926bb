// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "phiz/anatomy/builtin/skin/form.h"

namespace phiz {
namespace {

/// The points of the proportions that steer the warp, millimetres, both sides; the foot of the neck stays.
std::vector<Vector3d> anchors(const Proportions& p) {
  std::vector<Vector3d> points = {{0, -175, 10},  {0, -175, -95},  {60, -175, -45}, {-60, -175, -45},
                                  {0, -120, -90}, {55, -110, -40}, {-55, -110, -40}};
  for (const Vector2d* m :
       {&p.vertex, &p.opisthocranion, &p.trichion, &p.glabella, &p.nasion, &p.pronasale, &p.subnasale,
        &p.labrale_superius, &p.stomion, &p.labrale_inferius, &p.sublabiale, &p.pogonion, &p.menton})
    points.emplace_back(0, m->x() * 1e3, m->y() * 1e3);
  for (const Vector3d* s : {&p.eye_centre, &p.endocanthion, &p.exocanthion, &p.alare, &p.cheilion, &p.zygion, &p.gonion,
                            &p.tragion, &p.euryon})
    for (const double side : {1.0, -1.0}) points.emplace_back(side * s->x() * 1e3, s->y() * 1e3, s->z() * 1e3);
  return points;
}

/// Interpolates displacements at the anchors by the biharmonic spline (kernel r) with an affine part.
class Warp {
 public:
  Warp(const std::vector<Vector3d>& from, const std::vector<Vector3d>& to) : anchors_(from) {
    const Eigen::Index n = static_cast<Eigen::Index>(from.size());
    MatrixXd A = MatrixXd::Zero(n + 4, n + 4);
    MatrixX3d b = MatrixX3d::Zero(n + 4, 3);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) A(i, j) = (from[i] - from[j]).norm();
      A(i, n) = A(n, i) = 1;
      for (int k = 0; k < 3; ++k) A(i, n + 1 + k) = A(n + 1 + k, i) = from[i][k];
      b.row(i) = (to[i] - from[i]).transpose();
    }
    coefficients_ = A.fullPivLu().solve(b);
  }
  Vector3d displacement(const Vector3d& p) const {
    const Eigen::Index n = static_cast<Eigen::Index>(anchors_.size());
    Vector3d d = coefficients_.row(n).transpose();
    for (int k = 0; k < 3; ++k) d += p[k] * coefficients_.row(n + 1 + k).transpose();
    for (Eigen::Index i = 0; i < n; ++i) d += (p - anchors_[i]).norm() * coefficients_.row(i).transpose();
    return d;
  }

 private:
  std::vector<Vector3d> anchors_;
  MatrixX3d coefficients_;
};

/// What the proportions do not hold: a soft push of the flesh round a point of the left half (and its mirror image).
struct Push {
  double amount;          // standard deviations
  Vector3d centre;        // millimetres, mean head
  Vector3d radius;        // of the Gaussian bell
  Vector3d displacement;  // per standard deviation, millimetres
};

}  // namespace

void fit_person(SkinForm& form, const Proportions& proportions, const IdentityParameters& q) {
  const std::vector<Push> pushes = {
      {q.brow_ridge, {17, 45, 70}, {16, 7, 12}, {0, -0.4, 1.2}},
      {q.forehead_slope, {0, 85, 66}, {50, 22, 40}, {0, 0, -1.2}},
      {q.nose_bridge, {0, 18, 86}, {9, 12, 14}, {0, 0, 2.0}},
      {q.nose_width, {17, -5, 79}, {7, 8, 10}, {0.4, 0, 0}},
      {q.cheekbones, {48, 3, 52}, {17, 12, 18}, {1.5, 0.4, 1.8}},
      {q.cheek_fullness, {46, -24, 54}, {20, 21, 24}, {2.2, 0, 1.7}},
      {q.upper_lip, {0, -31, 88}, {22, 3.2, 12}, {0, 1.1, 0.9}},
      {q.lower_lip, {0, -45, 86}, {21, 3.6, 12}, {0, -1.1, 1.0}},
      {q.nose_tip_width, {7, -3, 93}, {5, 7, 8}, {0.9, 0, -0.2}},
      {q.brow_height, {28, 46, 66}, {20, 7, 16}, {0, 1.3, 0.1}},
      {q.chin_width, {16, -73, 76}, {9, 12, 14}, {1.4, 0, -0.2}},
      {q.neck_thickness, {55, -125, -40}, {45, 45, 60}, {4, 0, 0}},
      {q.neck_thickness, {0, -120, 10}, {40, 35, 30}, {0, 0, 2.5}},
      {q.fat, {46, -36, 44}, {26, 28, 32}, {2.7, -0.6, 1.3}},
      {q.fat, {10, -92, 40}, {32, 14, 28}, {0.4, -3.6, 1.0}},
      {q.fat, {50, -110, -20}, {40, 40, 50}, {2.5, 0, 0.8}},
  };
  const Warp warp(anchors(Proportions{}), anchors(proportions));
  const SkinTopology& topology = skin_topology();
  const auto displacement = [&](const Vector3d& p) {
    Vector3d d = warp.displacement(p);
    for (const Push& push : pushes)
      for (const double side : {1.0, -1.0}) {
        if (push.centre.x() == 0 && side < 0) continue;
        const Vector3d from(p.x() - side * push.centre.x(), p.y() - push.centre.y(), p.z() - push.centre.z());
        const double bell = std::exp(-0.5 * from.cwiseQuotient(push.radius).squaredNorm());
        d += push.amount * bell * Vector3d(side * push.displacement.x(), push.displacement.y(), push.displacement.z());
      }
    return d;
  };
  // The auricle keeps its form: it moves as a whole, with its root on the head.
  std::vector<double> in_ear(topology.left_count(), 0.0);
  Vector3d with_root = Vector3d::Zero();
  for (int c = 0; c < SkinTopology::ear_columns; ++c) {
    with_root += displacement(form.at(topology.ear(0, c))) / SkinTopology::ear_columns;
    for (int ring = 0; ring <= SkinTopology::ear_rings; ++ring)
      in_ear[topology.ear(ring, c)] = std::min(1.0, 0.5 + 0.125 * ring);
  }
  for (int u = 1; u < 4; ++u)
    for (int v = 1; v < 4; ++v) in_ear[topology.concha(u, v)] = 1;
  for (int v = 0; v < topology.left_count(); ++v)
    if (form.placed(v))
      form.place(v, form.at(v) + in_ear[v] * with_root + (1 - in_ear[v]) * displacement(form.at(v)), form.weight[v]);
}

}  // namespace phiz
