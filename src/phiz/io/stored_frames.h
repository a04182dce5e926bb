// SPDX-License-Identifier: GPL-3.0-or-later
/// The frames of a take inside a .phiz file. Private to the container.
#pragma once

#include "phiz/face/take.h"
#include "phiz/io/hdf5_group.h"

namespace phiz {

/// Sizes that every frame of a take has.
struct FrameSizes {
  Eigen::Index skin = 0;
  Eigen::Index weights = 0;
  Eigen::Index volume = 0;    ///< 0: frames have no volume
  Eigen::Index velocity = 0;  ///< 0: frames have no velocity
};

FrameSizes sizes_of(const TakeFrame& frame);
bool operator==(const FrameSizes& a, const FrameSizes& b);

/// Makes the growing arrays of the group.
void create_frames(const Hdf5Group& group, const FrameSizes& sizes);
/// Sizes that the arrays have; throws unless each of them has `frames` frames.
FrameSizes stored_sizes(const Hdf5Group& group, int frames);

void store_frame(const Hdf5Group& group, int index, const TakeFrame& frame);
/// Throws when a position or a pose is not finite or a rotation is none.
TakeFrame stored_frame(const Hdf5Group& group, int index, const FrameSizes& sizes);

/// Metres from the head within which everything that a take shows must lie.
inline constexpr double farthest = 100;

/// Whether all points are finite and no coordinate is beyond `farthest`.
template <class Points>
bool is_near(const Points& points) {
  return points.size() == 0 || points.cwiseAbs().template maxCoeff<Eigen::PropagateNaN>() <= farthest;
}

/// The first thing that is not finite, far away from the head or no rotation, or nothing.
std::string defect_of(const TakeFrame& frame);

}  // namespace phiz
