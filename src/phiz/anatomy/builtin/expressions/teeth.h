// SPDX-License-Identifier: GPL-3.0-or-later
/// The dental arches as something that lips and cheeks slide on.
#pragma once

#include <vector>

#include "phiz/anatomy/builtin/expressions/flesh.h"
#include "phiz/anatomy/builtin/proportions.h"
#include "phiz/anatomy/head_template.h"

namespace phiz {

/// Keeps the skin in front of the arches (inner lips, cheeks, vermilion) outside of both elliptic walls; the lower one
/// moves with the jaw. Vertices that start nearer than the clearance keep the distance that they have.
Obstacle dental_arches(const HeadTemplate& head, const Proportions::DentalArch& arch, const Eigen::Isometry3d& jaw);

/// The floor of the mouth goes with the jaw, between whose halves it is spread.
std::vector<Handle> floor_handles(const HeadTemplate& head, const Eigen::Isometry3d& jaw);

}  // namespace phiz
