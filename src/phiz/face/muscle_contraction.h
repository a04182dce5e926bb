// SPDX-License-Identifier: GPL-3.0-or-later
/// Muscles told directly how long to be, whatever expression that makes (phace.md section 4).
#pragma once

#include <vector>

#include "phiz/face/head_tissue.h"

namespace phiz {

/// The stretch that every tet of tissue.body strives for when muscle m of the head strives for gamma[m] times its
/// length: gamma along its fibres and gamma^(-1/2) across, which keeps the volume; the mean by fractions where muscles
/// share a tet, I where there is none. Throws phiz::Error(bad_input) unless there is one gamma per muscle, each within
/// least_activation and most_activation.
std::vector<Matrix3d> contract_muscles(const HeadTemplate& head, const HeadTissue& tissue, const VectorXd& gamma);

}  // namespace phiz
