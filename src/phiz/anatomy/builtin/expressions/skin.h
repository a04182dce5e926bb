// SPDX-License-Identifier: GPL-3.0-or-later
/// Reading named regions of the drawn skin, for the controls of the expressions.
#pragma once

#include <string>
#include <vector>

#include "phiz/anatomy/head_template.h"

namespace phiz {

/// A region's vertices of the drawn skin. Throws phiz::Error(bad_input) when it is missing or has fewer than 3.
const VectorXi& skin_region(const HeadTemplate& head, const std::string& name);

/// Positions of an ordered region of the drawn skin, metres.
MatrixX3d skin_curve(const HeadTemplate& head, const std::string& region);

/// 1 per entry of head.skin_vertices that belongs to one of the regions, else 0. Missing regions count as empty.
std::vector<char> simulation_mask(const HeadTemplate& head, const std::vector<std::string>& regions);

}  // namespace phiz
