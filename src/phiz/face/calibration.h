// SPDX-License-Identifier: GPL-3.0-or-later
/// How strongly muscles must pull for an expression to be as large as its sculpt: a stop-gap until activations are
/// solved for (inverse physics).
#pragma once

#include <functional>

#include "phiz/elasticity/solve_statistics.h"
#include "phiz/face/activation.h"

namespace phiz {

struct Calibration {
  std::string name;
  double gain = 1;     ///< that the change of the shape's activation was multiplied by
  double reached = 0;  ///< before: share of the sculpted displacement of the skin that the muscles reach
  double error = 0;    ///< before: root mean square distance to it, relative to its size
  SolveStatistics statistics;
};

struct CalibrationOptions {
  double probe = 1.3;  ///< the second gain that is tried
  double least = 0.7, most = 2;
  double towards_one = 0.01;  ///< weight of (gain - 1)^2 against the relative squared error of the skin
  std::function<void(const Calibration&)> report;  ///< told about each shape, when set
};

/// Multiplies the change of every shape by a gain. The static states at gain 1 and at the probe (neither contact nor
/// weight) give the skin as a linear function of the gain; the gain is the one whose skin is nearest to that of the
/// volumetric shape, weighted by area. Shapes that move the jaw keep gain 1: there the muscles' share in the motion is
/// too small to tell; so do shapes whose solve fails. mouthClose is tried on top of jawOpen, for which it is made.
/// `shapes` are those of the model, in its order, as estimate_activations() makes them. Takes two static solves per
/// shape. Throws phiz::Error for models whose shapes have no displacement.
std::vector<Calibration> calibrate_activations(const FaceModel& model, const HeadTissue& tissue,
                                               std::vector<ActivationShape>& shapes,
                                               const CalibrationOptions& options = {});

}  // namespace phiz
