// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/contact_planes.h"

#include <cmath>

namespace phiz {

namespace {

/// Weighted sum of the vertices of a row.
Vector3d relative_place(const ContactRow& row, const MatrixX3d& x) {
  Vector3d sum = Vector3d::Zero();
  for (int k = 0; k < row.count; ++k) sum += row.coefficients[k] * x.row(row.vertices[k]).transpose();
  return sum;
}

/// Length of the derivative of a row's gap by the unknowns.
double mobility(const ContactRow& row, const FreeMotion& motion) {
  double sum = 0;
  for (int k = 0; k < row.count; ++k)
    sum += (row.coefficients[k] * motion.directions(row.vertices[k]).transpose() * row.normal).squaredNorm();
  return std::sqrt(sum);
}

Matrix3d frame_of(const Vector3d& normal) {
  Matrix3d frame;
  frame.col(0) = normal;
  frame.col(1) = normal.unitOrthogonal();
  frame.col(2) = normal.cross(frame.col(1));
  return frame;
}

}  // namespace

ContactPlanes::ContactPlanes(const std::vector<ContactRow>& rows, const FreeMotion& motion, const MatrixX3d& x,
                             const MatrixX3d& reference) {
  constexpr double immovable = 0.05;  // a vertex on a slide that faces the plane
  for (const ContactRow& row : rows) {
    if (mobility(row, motion) < immovable) continue;
    rows_.push_back(row);
    frames_.push_back(frame_of(row.normal));
  }
  offsets_.resize(3, size());
  for (Eigen::Index i = 0; i < size(); ++i) {
    const ContactRow& row = rows_[static_cast<std::size_t>(i)];
    offsets_.col(i) = -frame(i).transpose() * relative_place(row, reference);
    offsets_(0, i) = row.gap - row.normal.dot(relative_place(row, x));
  }
}

Eigen::Matrix3Xd ContactPlanes::separation(const MatrixX3d& x) const {
  Eigen::Matrix3Xd out = offsets_;
  for (Eigen::Index i = 0; i < size(); ++i)
    out.col(i) += frame(i).transpose() * relative_place(rows_[static_cast<std::size_t>(i)], x);
  return out;
}

Eigen::SparseMatrix<double> ContactPlanes::derivative(const FreeMotion& motion) const {
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index i = 0; i < size(); ++i) {
    const ContactRow& row = rows_[static_cast<std::size_t>(i)];
    for (int k = 0; k < row.count; ++k) {
      const int first = motion.first(row.vertices[k]);
      if (first < 0) continue;
      const MatrixXd part = row.coefficients[k] * motion.directions(row.vertices[k]).transpose() * frame(i);
      for (Eigen::Index a = 0; a < part.rows(); ++a)
        for (Eigen::Index b = 0; b < 3; ++b)
          entries.emplace_back(first + static_cast<int>(a), static_cast<int>(3 * i + b), part(a, b));
    }
  }
  Eigen::SparseMatrix<double> out(motion.size(), 3 * size());
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

std::vector<ContactRow> detect_afresh(ContactScene& contacts, const MatrixX3d& x) {
  const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> positions = x;
  contacts.forget();
  return contacts.detect({positions.data(), 3, nullptr}, 0);
}

}  // namespace phiz
