// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/complementarity.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace phiz {

Eigen::VectorXd solve_complementarity(const Eigen::MatrixXd& M, const Eigen::VectorXd& q, std::vector<char>& active) {
  const Eigen::Index n = q.size();
  Eigen::VectorXd lambda = Eigen::VectorXd::Zero(n);
  if (n == 0) return lambda;
  active.resize(static_cast<std::size_t>(n), 0);
  // Tolerances in the unit of each side: gaps relative to the largest one, multipliers accordingly.
  const double gap_scale = std::max(q.cwiseAbs().maxCoeff(), 1e-12);
  const double gap_tolerance = 1e-10 * gap_scale;
  const double lambda_tolerance = gap_tolerance / M.diagonal().maxCoeff();
  Eigen::Index fewest = n + 1;
  int patience = 3;
  std::vector<Eigen::Index> set, wrong;
  for (int round = 0; round < 50 + 10 * static_cast<int>(n); ++round) {
    set.clear();
    for (Eigen::Index i = 0; i < n; ++i)
      if (active[static_cast<std::size_t>(i)]) set.push_back(i);
    lambda.setZero();
    Eigen::VectorXd gap = q;
    if (!set.empty()) {
      const Eigen::MatrixXd columns = M(Eigen::all, set);
      const Eigen::LLT<Eigen::MatrixXd> llt(columns(set, Eigen::all));
      if (llt.info() != Eigen::Success) return {};
      const Eigen::VectorXd values = llt.solve(-q(set));
      lambda(set) = values;
      gap += columns * values;
    }
    wrong.clear();
    for (Eigen::Index i = 0; i < n; ++i)
      if (active[static_cast<std::size_t>(i)] ? lambda[i] < -lambda_tolerance : gap[i] < -gap_tolerance)
        wrong.push_back(i);
    if (wrong.empty()) return lambda.cwiseMax(0.0);
    // Exchange all offending rows while their number falls; else only the last one (Murty's rule, which is finite).
    const auto count = static_cast<Eigen::Index>(wrong.size());
    if (count < fewest) {
      fewest = count;
      patience = 3;
    } else if (patience > 0) {
      --patience;
    } else {
      wrong = {wrong.back()};
    }
    for (const Eigen::Index i : wrong) active[static_cast<std::size_t>(i)] ^= 1;
  }
  return {};
}

}  // namespace phiz
