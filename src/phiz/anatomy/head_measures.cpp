// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/head_measures.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "phiz/anatomy/face_frame.h"
#include "phiz/anatomy/fibres.h"
#include "phiz/anatomy/muscle_table.h"
#include "phiz/core/parallel.h"
#include "phiz/geometry/operators.h"
#include "phiz/geometry/spatial_query.h"
#include "phiz/geometry/surface.h"

namespace phiz {
namespace {

/// Centre and principal axes of the volume that a muscle fills, by its tets; variances ascend.
struct Principal {
  Vector3d centre = Vector3d::Zero();
  Matrix3d axes = Matrix3d::Identity();
  Vector3d variance = Vector3d::Ones();
};

Principal principal_axes(const MatrixX3d& points, const VectorXd& weights) {
  Principal p;
  p.centre = points.transpose() * weights / weights.sum();
  const MatrixX3d from = points.rowwise() - p.centre.transpose();
  const Matrix3d covariance = from.transpose() * weights.asDiagonal() * from / weights.sum();
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(covariance);
  p.axes = solver.eigenvectors();
  p.variance = solver.eigenvalues();
  return p;
}

/// What a ring goes round: normal of the areas that its fibres span.
Vector3d ring_normal(const Muscle& muscle, const Principal& p) {
  Vector3d area = Vector3d::Zero();
  for (const MatrixX3d& fibre : muscle.fibres)
    for (Eigen::Index i = 0; i + 1 < fibre.rows(); ++i) {
      const Vector3d a = fibre.row(i).transpose() - p.centre, b = fibre.row(i + 1).transpose() - p.centre;
      area += a.cross(b);
    }
  return area.isZero(0) ? Vector3d(p.axes.col(0)) : area.normalized();
}

/// The way round a ring at each row of `points`: between the centres of the sectors on either side, of twelve equal
/// ones in an ellipse. It follows the curve of lids and dental arch.
MatrixX3d ring_axes(const Vector3d& normal, const Principal& p, const MatrixX3d& points, const VectorXd& weights) {
  constexpr int sectors = 12;
  const Vector3d right = (p.axes.col(2) - normal.dot(p.axes.col(2)) * normal).normalized();
  const MatrixX3d from = points.rowwise() - p.centre.transpose();
  VectorXd x = from * right, y = from * normal.cross(right);
  x /= std::sqrt(x.cwiseAbs2().dot(weights));
  y /= std::sqrt(y.cwiseAbs2().dot(weights));
  std::vector<int> sector(static_cast<std::size_t>(points.rows()));
  MatrixX3d centres = MatrixX3d::Zero(sectors, 3);
  VectorXd sums = VectorXd::Zero(sectors);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const int k =
        static_cast<int>(std::floor((std::atan2(y[i], x[i]) / (2 * std::numbers::pi) + 1) * sectors)) % sectors;
    sector[static_cast<std::size_t>(i)] = k;
    centres.row(k) += weights[i] * points.row(i);
    sums[k] += weights[i];
  }
  for (int k = 0; k < sectors; ++k)
    if (sums[k] > 0) centres.row(k) /= sums[k];
  MatrixX3d axes(points.rows(), 3);
  for (Eigen::Index i = 0; i < axes.rows(); ++i) {
    const int k = sector[static_cast<std::size_t>(i)];
    axes.row(i) = (centres.row((k + 1) % sectors) - centres.row((k + sectors - 1) % sectors)).stableNormalized();
  }
  return axes;
}

/// From end to end of the whole muscle.
Vector3d long_axis(const Muscle& muscle, const Principal& p) {
  constexpr double slender = 3;
  const MuscleFacts* facts = find_muscle_facts(muscle.name);
  const bool spindle = facts != nullptr ? facts->form == MuscleForm::spindle : p.variance[2] >= slender * p.variance[1];
  if (spindle || muscle.fibres.empty()) return p.axes.col(2);
  Vector3d way = Vector3d::Zero();
  for (const MatrixX3d& fibre : muscle.fibres) way += (fibre.row(fibre.rows() - 1) - fibre.row(0)).transpose();
  return way.stableNormalized();
}

/// The axis at each row of `points`: between the centres of the thirds of the volume along the long axis; that axis
/// itself where the muscle is about as broad as it is long.
MatrixX3d own_axes(const Vector3d& along, const Principal& p, const MatrixX3d& points, const VectorXd& weights) {
  constexpr double elongated = 2;
  const Matrix3d covariance = p.axes * p.variance.asDiagonal() * p.axes.transpose();
  const Matrix3d across = Matrix3d::Identity() - along * along.transpose();
  const double breadth = (across * covariance * across).norm();  // close to its largest eigenvalue, as sheets are thin
  const MatrixX3d straight = along.transpose().replicate(points.rows(), 1);
  if (along.dot(covariance * along) < elongated * breadth) return straight;
  std::vector<Eigen::Index> order(static_cast<std::size_t>(points.rows()));
  std::iota(order.begin(), order.end(), 0);
  const VectorXd place = points * along;
  std::sort(order.begin(), order.end(), [&place](Eigen::Index a, Eigen::Index b) { return place[a] < place[b]; });
  std::vector<int> third(order.size());
  MatrixX3d centres = MatrixX3d::Zero(3, 3);
  Vector3d sums = Vector3d::Zero();
  double before = 0;
  for (const Eigen::Index i : order) {
    const int k = std::clamp(static_cast<int>(3 * (before + 0.5 * weights[i]) / weights.sum()), 0, 2);
    third[static_cast<std::size_t>(i)] = k;
    before += weights[i];
    centres.row(k) += weights[i] * points.row(i);
    sums[k] += weights[i];
  }
  if (sums.minCoeff() <= 0) return straight;  // hardly any tets
  for (int k = 0; k < 3; ++k) centres.row(k) /= sums[k];
  MatrixX3d axes(points.rows(), 3);
  for (Eigen::Index i = 0; i < axes.rows(); ++i) {
    const int k = third[static_cast<std::size_t>(i)];
    axes.row(i) = (centres.row(std::min(k + 1, 2)) - centres.row(std::max(k - 1, 0))).stableNormalized();
  }
  return axes;
}

/// Value below which half of the weight lies.
double weighted_median(std::vector<std::pair<double, double>> values) {
  std::sort(values.begin(), values.end());
  double all = 0, sum = 0;
  for (const auto& [value, weight] : values) all += weight;
  for (const auto& [value, weight] : values)
    if ((sum += weight) >= 0.5 * all) return value;
  return std::numeric_limits<double>::quiet_NaN();
}

/// The vertices of an incisal edge: those of the front teeth within 1 mm of their extreme height (sign: 1 highest).
MatrixX3d incisal_edge(const MatrixX3d& V, double sign) {
  constexpr double half_width = 0.006, depth = 0.008, edge = 0.001;
  double front = -std::numeric_limits<double>::infinity(), extreme = front;
  for (Eigen::Index i = 0; i < V.rows(); ++i)
    if (std::abs(V(i, 0)) < half_width) front = std::max(front, V(i, 2));
  const auto incisor = [&](Eigen::Index i) { return std::abs(V(i, 0)) < half_width && V(i, 2) > front - depth; };
  for (Eigen::Index i = 0; i < V.rows(); ++i)
    if (incisor(i)) extreme = std::max(extreme, sign * V(i, 1));
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < V.rows(); ++i)
    if (incisor(i) && sign * V(i, 1) > extreme - edge) rows.push_back(i);
  return V(rows, Eigen::all);
}

}  // namespace

MuscleFigures muscle_figures(const HeadTemplate& head, const Muscle& muscle) {
  MuscleFigures figures;
  figures.name = muscle.name;
  if (muscle.surface.F.rows() > 0) figures.share_in_flesh = share_in_flesh(head.volume, muscle.surface);
  if (muscle.tets.size() == 0) {
    figures.angle = std::numeric_limits<double>::infinity();
    return figures;
  }
  MatrixX3d centres(muscle.tets.size(), 3);
  VectorXd weights(muscle.tets.size());
  for (Eigen::Index i = 0; i < muscle.tets.size(); ++i) {
    const auto corners = head.volume.T.row(muscle.tets[i]);
    centres.row(i) = head.volume.V(corners, Eigen::all).colwise().mean();
  }
  weights = muscle.fraction.cwiseProduct(tet_volumes(head.volume.V, head.volume.T(muscle.tets, Eigen::all)));
  figures.volume = weights.sum();
  const Principal p = principal_axes(centres, weights);
  const MatrixX3d axes = muscle.ring ? ring_axes(ring_normal(muscle, p), p, centres, weights)
                                     : own_axes(long_axis(muscle, p), p, centres, weights);
  std::vector<std::pair<double, double>> angles;
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    const double along = std::min(1.0, std::abs(axes.row(i).dot(muscle.direction.row(i))));
    angles.emplace_back(std::acos(along) * 180 / std::numbers::pi, weights[i]);
  }
  figures.angle = weighted_median(angles);
  return figures;
}

Occlusion occlusion(const HeadTemplate& head) {
  Occlusion result;
  const Part* upper = find_part(head, "upperTeeth");
  const Part* lower = find_part(head, "lowerTeeth");
  if (upper == nullptr || lower == nullptr || upper->mesh.F.rows() == 0 || lower->mesh.F.rows() == 0) return result;
  const MatrixX3d above = incisal_edge(upper->mesh.V, -1), below = incisal_edge(lower->mesh.V, 1);
  if (above.rows() == 0 || below.rows() == 0) return result;
  result.known = true;
  result.overbite = below.col(1).maxCoeff() - above.col(1).minCoeff();
  result.overjet = above.col(2).maxCoeff() - below.col(2).maxCoeff();
  const VectorXd up = SurfaceQuery(lower->mesh).signed_distances(upper->mesh.V);
  const VectorXd down = SurfaceQuery(upper->mesh).signed_distances(lower->mesh.V);
  const double least = std::min(up.minCoeff(), down.minCoeff());
  result.gap = std::max(0.0, least);
  result.interpenetration = std::max(0.0, -least);
  return result;
}

std::vector<ExpressionFigures> expression_figures(const HeadTemplate& head) {
  std::vector<ExpressionFigures> figures(head.expressions.size());
  const Expression* open = find_expression(head, "jawOpen");
  parallel_for(
      static_cast<std::ptrdiff_t>(figures.size()),
      [&](std::ptrdiff_t i) {
        const Expression& e = head.expressions[static_cast<std::size_t>(i)];
        MatrixX3d displacement = e.displacement;
        if (e.name == "mouthClose" && open != nullptr) displacement += open->displacement;
        figures[static_cast<std::size_t>(i)] = {e.name, self_intersections(simulation_skin(head, displacement)).size()};
      },
      1);
  return figures;
}

double active_share_of_face(const HeadTemplate& head) {
  const FaceFrame frame = face_frame(head);
  const VectorXd volume = tet_volumes(head.volume.V, head.volume.T);
  const auto in_face = [&](int t) {
    const Eigen::RowVector3d c = head.volume.V(head.volume.T.row(t), Eigen::all).colwise().mean();
    return head.volume.region(t) == Tissue::flesh && c.z() > head.jaw.centre.z() && c.y() > frame.menton &&
           c.y() < frame.brow;
  };
  double all = 0, active = 0;
  for (int t = 0; t < head.volume.T.rows(); ++t) all += in_face(t) ? volume(t) : 0;
  for (const Muscle& m : head.muscles)
    for (Eigen::Index i = 0; i < m.tets.size(); ++i)
      active += in_face(m.tets(i)) ? m.fraction(i) * volume(m.tets(i)) : 0;
  return all > 0 ? active / all : 0;
}

}  // namespace phiz
