// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/elasticity/static_residual.h"

#include <algorithm>
#include <cmath>

#include "phiz/geometry/operators.h"

namespace phiz {

VectorXd micrometre_forces2(const TissueBody& body) {
  constexpr double micrometre = 1e-6;
  const TetRest rest = tet_rest(body.rest, body.tets);
  VectorXd stiffness = VectorXd::Zero(body.rest.rows());
  for (Eigen::Index t = 0; t < body.tets.rows(); ++t) {
    const auto s = static_cast<std::size_t>(t);
    const Eigen::Matrix<double, 3, 4> hats = hat_gradients(rest.inverse_edges[s]);
    for (int k = 0; k < 4; ++k)
      stiffness[body.tets(t, k)] += 2 * body.moduli[s].mu * rest.volume[t] * hats.col(k).squaredNorm();
  }
  return (micrometre * stiffness).array().square();
}

ForceScale::ForceScale(const TissueBody& body) : least2_(micrometre_forces2(body)) {}

double ForceScale::operator()(const FreeMotion& motion, const VectorXd& magnitude) const {
  double scale2 = 0, least2 = 0;
  for (Eigen::Index v = 0; v < magnitude.size(); ++v) {
    if (motion.first(v) < 0) continue;
    scale2 += magnitude[v] * magnitude[v];
    least2 += least2_[v];
  }
  return std::sqrt(std::max(scale2, least2));
}

}  // namespace phiz
