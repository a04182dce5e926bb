// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/contact_compliance.h"

#include <algorithm>

#include "phiz/core/parallel.h"

namespace phiz {

namespace {

// A row is near enough to the one that was solved for while its normal has turned by less than 8 degrees and its
// obstacle has slipped by less than this below it, metres.
constexpr float same_direction = 0.99F;
constexpr float longest_slip = 7e-4F;
/// Groups of which less than this share is in use are made anew.
constexpr double least_use = 0.4;

}  // namespace

void ContactCompliance::clear() {
  groups_.clear();
  slot_.clear();
  slot_of_.clear();
  gram_.resize(0, 0);
}

std::vector<int> ContactCompliance::find_slots(const BlockCholesky& factor, const std::vector<FactorRow>& rows) {
  if (static_cast<double>(rows.size()) < least_use * slots() - 2 * SolvedRows::most) clear();
  std::vector<int> out(rows.size(), -1);
  std::vector<std::size_t> unknown;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto found = slot_of_.find(rows[i].key);
    if (found != slot_of_.end()) {
      const Slot& slot = slot_[static_cast<std::size_t>(found->second)];
      if (slot.normal.dot(rows[i].normal) > same_direction &&
          (slot.anchor - rows[i].anchor).squaredNorm() < longest_slip * longest_slip) {
        out[i] = found->second;
        continue;
      }
    }
    unknown.push_back(i);
  }
  if (unknown.empty()) return out;
  // Neighbours share their way to the root.
  std::stable_sort(unknown.begin(), unknown.end(),
                   [&](std::size_t a, std::size_t b) { return rows[a].entries.column[0] < rows[b].entries.column[0]; });
  const std::size_t before = groups_.size();
  constexpr auto most = static_cast<std::size_t>(SolvedRows::most);
  const std::size_t added = (unknown.size() + most - 1) / most;
  groups_.resize(before + added);
  slot_.resize(most * groups_.size());
  gram_.conservativeResize(slots(), slots());
  parallel_for(
      static_cast<std::ptrdiff_t>(added),
      [&](std::ptrdiff_t g) {
        std::vector<SparseRow> entries;
        const std::size_t first = most * static_cast<std::size_t>(g);
        for (std::size_t i = first; i < std::min(first + most, unknown.size()); ++i)
          entries.push_back(rows[unknown[i]].entries);
        groups_[before + static_cast<std::size_t>(g)] = factor.forward_rows(entries);
      },
      1);
  for (std::size_t i = 0; i < unknown.size(); ++i) {
    const FactorRow& row = rows[unknown[i]];
    const std::size_t slot = most * before + i;
    slot_[slot] = {row.key, row.normal, row.anchor};
    slot_of_[row.key] = static_cast<int>(slot);
    out[unknown[i]] = static_cast<int>(slot);
  }
  parallel_for(
      static_cast<std::ptrdiff_t>(added),
      [&](std::ptrdiff_t g) {
        const std::size_t a = before + static_cast<std::size_t>(g);
        for (std::size_t b = 0; b <= a; ++b) {
          const auto block = groups_[a].gram(groups_[b]);
          const auto i = static_cast<Eigen::Index>(most * a), k = static_cast<Eigen::Index>(most * b);
          gram_.block<SolvedRows::most, SolvedRows::most>(i, k) = block;
          gram_.block<SolvedRows::most, SolvedRows::most>(k, i) = block.transpose();
        }
      },
      1);
  return out;
}

Eigen::VectorXf ContactCompliance::products(const float* v) const {
  Eigen::VectorXf out(slots());
  for (std::size_t g = 0; g < groups_.size(); ++g)
    out.segment<SolvedRows::most>(static_cast<Eigen::Index>(SolvedRows::most * g)) = groups_[g].products(v);
  return out;
}

void ContactCompliance::add(const Eigen::VectorXf& weights, float* v) const {
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const Eigen::Matrix<float, SolvedRows::most, 1> mine =
        weights.segment<SolvedRows::most>(static_cast<Eigen::Index>(SolvedRows::most * g));
    if (!mine.isZero(0)) groups_[g].add(mine, v);
  }
}

}  // namespace phiz
