// SPDX-License-Identifier: GPL-3.0-or-later
/// How the validation of a head says what is wrong. Private to validate_head.cpp and validate_anatomy.cpp.
#pragma once

#include <cmath>
#include <set>
#include <string>

#include "phiz/anatomy/head_template.h"
#include "phiz/core/error.h"

namespace phiz {

inline constexpr double farthest_from_head = 1;  ///< metres, for anything that belongs to a head

/// Says what is wrong with one item of the head.
class HeadCheck {
 public:
  explicit HeadCheck(std::string where) : where_(std::move(where)) {}

  [[noreturn]] void wrong(const std::string& what, const std::string& mend = {}) const { reject(where_, what, mend); }
  void that(bool right, const std::string& what, const std::string& mend = {}) const {
    if (!right) wrong(what, mend);
  }

  template <class Derived>
  void finite(const Eigen::MatrixBase<Derived>& m, const std::string& name) const {
    for (Eigen::Index i = 0; i < m.rows(); ++i)
      for (Eigen::Index j = 0; j < m.cols(); ++j)
        if (!std::isfinite(static_cast<double>(m(i, j)))) wrong(name + " row " + std::to_string(i) + " is not finite");
  }

  /// Points within reach of the head; so none is in another unit or not finite.
  void nearby(const MatrixX3d& points, const std::string& name) const {
    for (Eigen::Index i = 0; i < points.rows(); ++i)
      if (!(points.row(i).norm() <= farthest_from_head))
        wrong(name + " (row " + std::to_string(i) + ") is more than " +
                  std::to_string(static_cast<int>(farthest_from_head)) + " m away from the head",
              "positions must be in metres");
  }

  template <class Derived>
  void rows_below(const Eigen::MatrixBase<Derived>& m, Eigen::Index limit, const std::string& name) const {
    for (Eigen::Index i = 0; i < m.rows(); ++i)
      for (Eigen::Index j = 0; j < m.cols(); ++j)
        if (m(i, j) < 0 || m(i, j) >= limit)
          wrong(name + " row " + std::to_string(i) + " refers to " + std::to_string(m(i, j)) + ", but there are " +
                std::to_string(limit));
  }

  void weights(const SparseMatrixd& W, Eigen::Index rows, Eigen::Index columns, const std::string& name) const {
    that(W.rows() == rows && W.cols() == columns, name + " is " + std::to_string(W.rows()) + " x " +
                                                      std::to_string(W.cols()) + ", expected " + std::to_string(rows) +
                                                      " x " + std::to_string(columns));
    for (Eigen::Index i = 0; i < W.outerSize(); ++i) {
      double sum = 0;
      for (SparseMatrixd::InnerIterator it(W, i); it; ++it) sum += it.value();
      that(std::abs(sum - 1) < 1e-6,
           name + " row " + std::to_string(i) + " sums to " + std::to_string(sum) + ", not 1");
    }
  }

  void fresh(std::set<std::string>& names, const std::string& name, const std::string& kind) const {
    that(!name.empty(), "a " + kind + " has no name");
    that(names.insert(name).second, "the " + kind + " " + name + " occurs twice");
  }

  const std::string& where() const { return where_; }

 private:
  std::string where_;
};

/// Muscles, attachments, the model of people, landmarks and contacts.
void check_anatomy(const HeadTemplate& head, const HeadCheck& check);

}  // namespace phiz
