// SPDX-License-Identifier: GPL-3.0-or-later
/// Eyelashes as hairs on a sheet that springs from the margin of a lid.
#pragma once

#include <cstdint>
#include <vector>

#include "phiz/geometry/mesh.h"

namespace phiz {

/// Lines along the lid from the inner to the outer corner, all with as many points: the first through the roots, the
/// last through the tips of the longest lashes. Metres.
using LashSheet = std::vector<MatrixX3d>;

/// The sheet that lashes of usual length lie on: off the margin (n x 3, from the inner to the outer corner), away from
/// the eye, bent up on an upper lid and down on a lower one; longest beyond the middle.
LashSheet lash_sheet(const MatrixX3d& margin, const Vector3d& eye_centre, bool upper);

/// The lashes of an eye, 120 on the upper lid and 75 on the lower one, in turns on each of a lid's sheets: closed tubes
/// that taper, each a connected piece. They differ in length and lean together in tufts. Same `seed`, same lashes.
TriangleMesh grow_lashes(const std::vector<LashSheet>& upper, const std::vector<LashSheet>& lower, std::uint64_t seed);

}  // namespace phiz
