// SPDX-License-Identifier: GPL-3.0-or-later
/// Contact rows that keep their planes while a solver moves the vertices (phace.md section 4.5). Not a public header.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "phiz/elasticity/contact.h"
#include "phiz/elasticity/tissue_body.h"

namespace phiz {

class ContactPlanes {
 public:
  ContactPlanes() = default;
  /// Rows that were detected at x. Those that no vertex can do anything about are dropped. Slip is measured from
  /// `reference`, n x 3.
  ContactPlanes(const std::vector<ContactRow>& rows, const FreeMotion& motion, const MatrixX3d& x,
                const MatrixX3d& reference);

  Eigen::Index size() const { return static_cast<Eigen::Index>(rows_.size()); }
  const std::vector<ContactRow>& rows() const { return rows_; }
  /// Normal and two tangents of a contact, as columns.
  const Matrix3d& frame(Eigen::Index contact) const { return frames_[static_cast<std::size_t>(contact)]; }

  /// What a contact's vertices have moved against each other, in its frame: the gap to its plane and the slip, metres;
  /// 3 x m.
  Eigen::Matrix3Xd separation(const MatrixX3d& x) const;
  /// Derivative of the separation by the unknowns of a motion, transposed: column 3 i + k is that of entry (k, i).
  Eigen::SparseMatrix<double> derivative(const FreeMotion& motion) const;

 private:
  std::vector<ContactRow> rows_;
  std::vector<Matrix3d> frames_;
  Eigen::Matrix3Xd offsets_;
};

/// Rows of planes that are as fresh as can be.
std::vector<ContactRow> detect_afresh(ContactScene& contacts, const MatrixX3d& x);

}  // namespace phiz
