// SPDX-License-Identifier: GPL-3.0-or-later
/// Few shapes whose weighted sums make all frames of an animation.
#pragma once

#include <vector>

#include "phiz/face/take.h"

namespace phiz {

/// frame f = rest + sum over k of weights(f, k) * shapes[k].
struct CompressedFrames {
  std::vector<MatrixX3f> shapes;  ///< displacements, n x 3, metres
  Eigen::MatrixXf weights;        ///< f x k; the one of largest size in each column is 1
  double max_error = 0;           ///< largest distance of any vertex in any frame, metres
  double rms_error = 0;
};

/// Principal components of the displacements from `rest` (not from the mean: a frame at rest has zero weights), as
/// many as are needed to come within `tolerance` metres of every vertex in every frame. The errors are measured on the
/// stored single-precision numbers. All frames have as many rows as `rest`.
CompressedFrames compress_frames(const MatrixX3d& rest, const std::vector<const MatrixX3f*>& frames, double tolerance);

}  // namespace phiz
