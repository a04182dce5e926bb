// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <vector>

#include "phiz/anatomy/builtin/skin/form.h"

namespace phiz {
namespace {

constexpr int n = SkinTopology::eye_columns;
/// The inner edge of the lid margin about the centre of the mean eye (millimetres, x to the temple for the left eye),
/// from the inner canthus over the upper lid to the outer canthus and back along the lower lid. z follows the eyeball
/// where it can.
constexpr double margin_x[n] = {-14.6, -11.6, -8.4, -4.6, -0.4, 4,    8,    11.3,
                                13.6,  11,    7.6,  3.6,  -0.6, -4.6, -8.4, -11.6};
constexpr double margin_y[n] = {-1.6, 0.6,  2.3,  3.5,  3.9,  3.7,  2.75, 1.4,
                                0.4,  -1.7, -3.8, -5.1, -5.6, -5.2, -4.1, -2.8};
constexpr double margin_z[n] = {6.2, 6.8, 0, 0, 0, 0, 0, 4.4, 3.2, 4, 0, 0, 0, 0, 0, 6.6};  // least depth

constexpr double clearance = 0.25;      // between eyeball and lid, millimetres
constexpr double back_clearance = 0.9;  // where nobody sees it
constexpr double caruncle = 0.5;        // how far it stands out from the eyeball
constexpr double margin_width = 1.7;
/// How far the skin between outer canthus and temple stands out from the straight way, millimetres.
constexpr double temple_round[n] = {0, 0, 0, 0, 0, 0.3, 1.1, 1.2, 0.8, 0.8, 0.5, 0, 0, 0, 0, 0};
/// How closely the lids follow the ball: less towards the canthi.
constexpr double follow[n] = {0, 0.4, 0.75, 0.95, 1, 0.9, 0.5, 0.15, 0, 0.08, 0.35, 0.8, 1, 1, 0.75, 0.4};

}  // namespace

void place_lids(SkinForm& form, const Proportions& proportions, const IdentityParameters& identity) {
  const SkinTopology& topology = skin_topology();
  const Vector3d centre = proportions.eye_centre * 1e3;
  const double radius = proportions.eye_radius * 1e3;
  const Proportions mean;
  const Vector3d inner = proportions.endocanthion * 1e3 - centre, outer = proportions.exocanthion * 1e3 - centre;
  const Vector3d mean_inner = (mean.endocanthion - mean.eye_centre) * 1e3,
                 mean_outer = (mean.exocanthion - mean.eye_centre) * 1e3;
  const double person_open = 1 + 0.12 * identity.eye_size;
  // Moves with the canthi, linearly in between.
  const auto margin = [&](int c, double open) {
    const double t = (margin_x[c] - margin_x[0]) / (margin_x[8] - margin_x[0]);
    const Vector3d shift = (1 - t) * (inner - mean_inner) + t * (outer - mean_outer);
    const double axis_y = (1 - t) * margin_y[0] + t * margin_y[8];
    const double x = margin_x[c] + shift.x(), y = axis_y + open * (margin_y[c] - axis_y) + shift.y();
    const double r = radius + clearance, ball = r * r - x * x - y * y;
    double z = ball > 0 ? std::sqrt(ball) : 0.0;
    if (margin_z[c] > 0) z = std::max(z, margin_z[c] + shift.z());
    return Vector3d(x, y, z);
  };

  for (int c = 0; c < n; ++c) {
    const double lid = std::sin(M_PI * (c < 8 ? c : 16 - c) / 8.0);  // 0 at the canthi, 1 in the middle
    const bool upper = c > 0 && c < 8;
    const Vector3d inner_edge = margin(c, person_open);
    const Vector3d outer_edge =
        inner_edge + margin_width * (inner_edge.normalized() * 0.85 + Vector3d(0, (upper ? 0.35 : -0.3) * lid, 0.25));
    form.place(topology.eye(6, c), centre + inner_edge, 1e4);
    form.place(topology.eye(5, c), centre + outer_edge, 1e3);
    // Across the lid to the rim on the sheet: fraction of the way and distance from the eyeball's surface.
    const Vector3d rim = form.at(topology.eye(0, c)) - centre;
    const double fraction[5] = {1, upper ? 0.64 : 0.88, upper ? 0.48 - 0.015 * identity.lid_fold : 0.72,
                                upper ? 0.44 : 0.44, upper ? 0.2 : 0.18};
    const double height[5] = {0, upper ? 8.8 + 0.5 * identity.lid_fold : 5.9,
                              upper ? 4.9 + 0.5 * identity.lid_fold : 4.9, upper ? 2.9 : 3.4, upper ? 2.8 : 2.6};
    const double hug[5] = {0, upper ? 1 : 0.3, upper ? 1 : 0.8, 1, 1};
    for (int ring = 1; ring <= 4; ++ring) {
      Vector3d p = outer_edge + fraction[ring] * (rim - outer_edge);
      p += follow[c] * hug[ring] * ((radius + height[ring]) * p.normalized() - p);
      p += temple_round[c] * 4 * fraction[ring] * (1 - fraction[ring]) * p.normalized();
      const double r_min = radius + 2.0;
      if (p.norm() < r_min) p *= r_min / p.norm();
      form.place(topology.eye(ring, c), centre + p, ring >= 2 ? 20 : 1);
    }
    // Socket: from the margin round the eyeball to the pole behind it. At the canthi the lining first runs over to the
    // front of the eyeball; at the inner one it swells to the caruncle.
    const bool inner_canthus = c == 0 || c == 1 || c == n - 1, outer_canthus = c == 8;
    const Vector3d start = margin(c, 1), around = Vector3d(start.x(), start.y(), 0).normalized();
    const double angle0 = std::acos(std::clamp(inner_edge.normalized().z(), -1.0, 1.0));
    for (int ring = 7; ring <= 9; ++ring) {
      constexpr double share[3] = {0.17, 0.50, 0.78}, inner_angle[3] = {1.02, 1.72, 2.42},
                       outer_angle[3] = {1.29, 1.85, 2.45};
      const double angle = inner_canthus   ? inner_angle[ring - 7]
                           : outer_canthus ? outer_angle[ring - 7]
                                           : angle0 + share[ring - 7] * (M_PI - angle0);
      const bool canthus = inner_canthus || outer_canthus;
      const double above = ring == 9 || (ring == 8 && !canthus) ? back_clearance
                           : ring == 8                          ? 0.4
                           : c == 0                             ? caruncle
                           : canthus                            ? clearance
                                                                : 0.62;
      const double r = radius + above;
      form.place(topology.eye(ring, c),
                 centre + r * Vector3d(std::sin(angle) * around.x(), std::sin(angle) * around.y(), std::cos(angle)),
                 1e4);
    }
  }
  for (int u = 1; u < 4; ++u)
    for (int v = 1; v < 4; ++v) {
      Vector3d p = Vector3d::Zero();  // blend of the four border vertices, pushed back to the sphere
      p += (4 - u) * form.at(topology.socket(0, v)) + u * form.at(topology.socket(4, v));
      p += (4 - v) * form.at(topology.socket(u, 0)) + v * form.at(topology.socket(u, 4));
      const Vector3d direction = p / 8 - centre - Vector3d(0, 0, 0.2 * radius);
      form.place(topology.socket(u, v), centre + (radius + back_clearance) * direction.normalized(), 1e4);
    }
}

void clear_eyeballs(SkinForm& form, const Proportions& proportions, const SparseMatrixd& fine_limit) {
  const SkinTopology& topology = skin_topology();
  const Vector3d centre = proportions.eye_centre * 1e3;
  const double least = proportions.eye_radius * 1e3 + 0.12;
  std::vector<char> movable(topology.vertex_count(), 0);
  for (int ring = 5; ring <= SkinTopology::eye_rings; ++ring)
    for (int c = 0; c < n; ++c) movable[topology.eye(ring, c)] = 1;
  for (int u = 1; u < 4; ++u)
    for (int v = 1; v < 4; ++v) movable[topology.socket(u, v)] = 1;
  constexpr int rounds = 20;
  for (int round = 0; round < rounds; ++round) {
    const MatrixX3d fine = fine_limit * form.X;
    MatrixX3d push = MatrixX3d::Zero(form.X.rows(), 3);
    bool clear = true;
    for (Eigen::Index f = 0; f < fine.rows(); ++f) {
      const Vector3d from = fine.row(f).transpose() - centre;
      if (from.norm() >= least) continue;
      clear = false;
      const Vector3d wanted = (least - from.norm() + 0.01) * from.normalized();
      for (SparseMatrixd::InnerIterator it(fine_limit, f); it;
           ++it) {  // the largest demand on each control vertex wins
        const Vector3d share = it.value() * wanted;
        if (movable[it.col()] && share.norm() > push.row(it.col()).norm()) push.row(it.col()) = share.transpose();
      }
    }
    if (clear) return;
    for (int v = 0; v < topology.left_count(); ++v)
      if (movable[v]) form.place(v, form.at(v) + push.row(v).transpose(), form.weight[v]);
  }
}

}  // namespace phiz
