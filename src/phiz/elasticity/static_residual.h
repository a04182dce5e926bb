// SPDX-License-Identifier: GPL-3.0-or-later
/// What a force left over in a static state is measured by. Not a public header.
#pragma once

#include "phiz/elasticity/tissue_body.h"

namespace phiz {

/// Squared force that moves each vertex alone by a micrometre, newtons^2.
VectorXd micrometre_forces2(const TissueBody& body);

/// The root of the sum over the vertices that can move of the squared sums of the norms of their tets' forces; at least
/// the root of the sum of the squared forces that move every one of them alone by a micrometre, so that states without
/// any force have a scale too.
class ForceScale {
 public:
  explicit ForceScale(const TissueBody& body);

  /// `magnitude`: what TissueEnergy::gradient() fills in.
  double operator()(const FreeMotion& motion, const VectorXd& magnitude) const;

 private:
  VectorXd least2_;
};

}  // namespace phiz
