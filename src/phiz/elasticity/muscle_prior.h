// SPDX-License-Identifier: GPL-3.0-or-later
/// What activations are likely (Ichim et al. 2017, section 5.1; phace.md 5.1 and 5.2): muscles shorten along their
/// fibres as a whole, and few of them do.
#pragma once

#include <vector>

#include "phiz/elasticity/constitutive.h"

namespace phiz {

/// One muscle: the tets that it is in, its share of each one's volume and its fibres there (unit).
struct MuscleFibres {
  VectorXi tets;
  VectorXd fraction;
  MatrixX3d direction;
};

/// The stretch of fibres along the unit vector d that are `contraction` times as long as at rest, at the same volume:
/// gamma along d, gamma^(-1/2) across, by gamma' = 1 / gamma in the source's Q^T diag(1 / gamma', ...) Q.
Matrix3d contracted_stretch(const Vector3d& direction, double contraction);

/// The contraction gamma that brings contracted_stretch() nearest to symmetric stretches S_i: minimises sum f_i |T_i -
/// S_i|^2 with p = sum f, q = sum f d.S d, r = sum f (tr S - d.S d), by all roots of 2 p s^6 - r s^5 + 2 q s^2 - 2 p,
/// s = gamma^(-1/2). 1 where p is 0.
double best_contraction(double p, double q, double r);

struct MusclePriorWeights {
  double direction = 1e-2;  ///< of R_act: mean over the muscles' volume of |contracted_stretch - S|^2
  double sparsity = 0;      ///< of R_sparse: sum over muscles of the root of their share of the mean of |S - I|^2
  double change = 1e-8;     ///< of the mean over the active tets' volume of |S - I|^2; > 0
  /// Of the mean of the squared excess of eigenvalues of S beyond these bounds.
  double excess = 10;
  double least_stretch = 0.5, most_stretch = 2;
};

/// Six activations per active tet, a column each.
using Activations = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// The sum of these terms over activations, for contractions that are found apart (fit()).
class MusclePrior {
 public:
  /// `tets`: the active ones, ascending, whose activations there are; `volumes` of all tets. What muscles have of other
  /// tets is ignored. Throws phiz::Error(bad_input) for malformed muscles.
  MusclePrior(const std::vector<MuscleFibres>& muscles, const VectorXi& tets, const VectorXd& volumes,
              const MusclePriorWeights& weights);

  /// Finds the contractions that lower the value the most.
  void fit(const Activations& a);
  const VectorXd& contractions() const { return contractions_; }

  double value(const Activations& a) const;
  Activations gradient(const Activations& a) const;
  /// Diagonal of a quadratic bound of the value at a, positive; stretches that come to exceed their bounds may cost
  /// more.
  Activations curvature(const Activations& a) const;
  /// Second derivative along v where contractions follow the activations, that of Gauss and Newton: `curvature` (that
  /// of the same state) less what a change of contractions accounts for.
  Activations curvature_times(const Activations& curvature, const Activations& v) const;

 private:
  struct Part {
    int column;    ///< into the activations
    double share;  ///< of the volume of all muscles
    Vector3d direction;
  };
  /// Square root of the share of |S - I|^2 that a muscle has, a little more than 0.
  double strength(std::size_t muscle, const Activations& a) const;
  /// What S has beyond the bounds, itself a symmetric matrix.
  Matrix3d excess(const Vector6d& a) const;

  MusclePriorWeights weights_;
  std::vector<std::vector<Part>> muscles_;
  VectorXd shares_;  ///< of every active tet in the volume of all of them
  VectorXd contractions_;
};

}  // namespace phiz
