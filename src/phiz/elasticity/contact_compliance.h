// SPDX-License-Identifier: GPL-3.0-or-later
/// How contact rows answer to each other's forces, C A^-1 C^T, on a factor of A. Rows that hardly changed since they
/// were solved for are not solved for again. Not a public header.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "phiz/numerics/block_cholesky.h"

namespace phiz {

/// A contact row in the numbering of the factor.
struct FactorRow {
  std::int64_t key = 0;  ///< pair, vertex and which of its faces: the same in the next iteration
  SparseRow entries;
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();
  Eigen::Vector3f anchor = Eigen::Vector3f::Zero();  ///< where it meets its obstacle, in the obstacle at rest
};

class ContactCompliance {
 public:
  /// To be called when the factor changed.
  void clear();

  /// Solves for the rows that are new or changed too much; returns the slot of each row.
  std::vector<int> find_slots(const BlockCholesky& factor, const std::vector<FactorRow>& rows);

  int slots() const { return static_cast<int>(SolvedRows::most * groups_.size()); }
  /// c_a A^-1 c_b.
  float compliance(int a, int b) const { return gram_(a, b); }
  /// L^-1 c . v of all slots, for a vector v in the coordinates of the factor, L^T x.
  Eigen::VectorXf products(const float* v) const;
  /// v <- v + sum over the slots of weight L^-1 c.
  void add(const Eigen::VectorXf& weights, float* v) const;

 private:
  struct Slot {
    std::int64_t key = -1;
    Eigen::Vector3f normal, anchor;
  };
  std::vector<SolvedRows> groups_;
  std::vector<Slot> slot_;
  Eigen::MatrixXf gram_;
  std::unordered_map<std::int64_t, int> slot_of_;
};

}  // namespace phiz
