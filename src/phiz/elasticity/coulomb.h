// SPDX-License-Identifier: GPL-3.0-or-later
/// Multipliers of contacts with dry friction.
#pragma once

#include <Eigen/Core>

namespace phiz {

/// For k contacts with three rows each (normal, two tangents), finds y = (pressure, friction) with w = M y + q:
/// 0 <= pressure, 0 <= w_n, pressure w_n = 0; |friction| <= mu pressure, and where w_t is not 0 friction = -mu pressure
/// w_t / |w_t|. M: 3k x 3k, symmetric positive definite; friction couples to pressure, so this is no minimum.
/// Semismooth Newton (Alart and Curnier 1991), made safe by projected Gauss-Seidel sweeps. `y` is the guess and the
/// result; returns whether the conditions hold to 1e-12 of its largest entry.
bool solve_coulomb(const Eigen::MatrixXd& M, const Eigen::VectorXd& q, double mu, Eigen::VectorXd& y);

}  // namespace phiz
