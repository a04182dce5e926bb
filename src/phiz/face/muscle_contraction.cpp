// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/face/muscle_contraction.h"

#include "phiz/core/error.h"
#include "phiz/elasticity/muscle_prior.h"
#include "phiz/face/activation.h"

namespace phiz {

std::vector<Matrix3d> contract_muscles(const HeadTemplate& head, const HeadTissue& tissue, const VectorXd& gamma) {
  if (gamma.size() != static_cast<Eigen::Index>(head.muscles.size()) ||
      !(gamma.array() >= least_activation && gamma.array() <= most_activation).all())
    reject("contraction", "needs one length per muscle, from a half to twice its own");
  const auto tets = static_cast<std::size_t>(head.volume.T.rows());
  std::vector<Matrix3d> sum(tets, Matrix3d::Zero());
  std::vector<double> share(tets, 0.0);
  for (std::size_t m = 0; m < head.muscles.size(); ++m) {
    const Muscle& muscle = head.muscles[m];
    for (Eigen::Index i = 0; i < muscle.tets.size(); ++i) {
      const Vector3d d = muscle.direction.row(i);
      const auto t = static_cast<std::size_t>(muscle.tets[i]);
      sum[t] += muscle.fraction[i] * contracted_stretch(d, gamma[static_cast<Eigen::Index>(m)]);
      share[t] += muscle.fraction[i];
    }
  }
  std::vector<Matrix3d> stretches;
  for (const int row : tissue.soft) {
    const auto t = static_cast<std::size_t>(row);
    stretches.push_back(share[t] > 0 ? Matrix3d(sum[t] / share[t]) : Matrix3d::Identity());
  }
  return stretches;
}

}  // namespace phiz
