// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/skin/people.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "phiz/numerics/pca.h"

namespace phiz {

IdentityModel builtin_people(const RefinedSkin& mean) {
  const Eigen::Index n = mean.mesh.V.rows();
  MatrixXd by_parameter(3 * n, identity_parameter_count);
  for (int i = 0; i < identity_parameter_count; ++i) {
    const auto cage = [i](double deviations) {
      IdentityParameters identity;
      identity.*identity_parameter_names[static_cast<std::size_t>(i)].value = deviations;
      return build_skin(personalise({}, identity), identity).cage.V;
    };
    const MatrixX3d displacement = mean.from_cage * (0.5 * (cage(1) - cage(-1)));
    by_parameter.col(i) = displacement.reshaped<Eigen::RowMajor>();
  }
  const MatrixXd factor = identity_covariance().llt().matrixL();
  const ThinSvd svd = thin_svd(by_parameter * factor);
  return {(svd.U * svd.s.asDiagonal()).cast<float>(), svd.s / std::sqrt(static_cast<double>(n))};
}

}  // namespace phiz
