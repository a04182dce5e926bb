// SPDX-License-Identifier: GPL-3.0-or-later
/// The flesh of a head as the elastic solver sees it.
#pragma once

#include "phiz/anatomy/head_template.h"
#include "phiz/elasticity/projective_dynamics.h"

namespace phiz {

/// Share of the stiffness per tet: 1 but for the flattest tets, which are softened down to a fiftieth. Flat tets (1 %
/// of the standard head's) sit where the lining of lips and lids is creased; at full stiffness a vertex between them
/// takes dozens of iterations to settle.
VectorXd flat_softening(const MatrixX3d& V, const MatrixX4i& T);

/// The elastic body of the soft tets: bone vertices fixed, one stiffness (pascals) times flat_softening(), no
/// attachments.
ElasticBody flesh_body(const HeadTemplate& head, const VectorXi& soft, const TermWeights& weights, double stiffness);

/// Sets the rows of vertices that move with skull or mandible to their places for a pose of the jaw.
void place_bones(const HeadTemplate& head, const JawPose& pose, MatrixX3d& x);

/// The pose within the limits of the joint.
JawPose clamp_to_limits(const JawJoint& joint, const JawPose& pose);

/// How far each vertex goes along with the jaw, in [0, 1]: harmonic in the flesh, 1 on the mandible, 0 on the skull.
VectorXd jaw_share(const HeadTemplate& head, const VectorXi& soft);

}  // namespace phiz
