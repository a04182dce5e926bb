// SPDX-License-Identifier: GPL-3.0-or-later
/// Unilateral multipliers of a small dense set of contact rows.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace phiz {

/// Rows whose gap would stay above this after the unconstrained step are left out of the problem at first, metres.
inline constexpr double idle_gap = 2e-4;

/// Solves 0 <= lambda, M lambda + q >= 0, lambda . (M lambda + q) = 0 for a symmetric positive definite M by block
/// principal pivoting (Judice and Pires 1994), finite for such M. `active`: guess of the rows with lambda > 0; holds
/// the solution's set on return. Returns lambda; an empty vector if the set did not settle (M not positive definite).
Eigen::VectorXd solve_complementarity(const Eigen::MatrixXd& M, const Eigen::VectorXd& q, std::vector<char>& active);

}  // namespace phiz
