// SPDX-License-Identifier: GPL-3.0-or-later
/// Which muscles made this face? The activations under which forward physics comes to the skin of an expression (Ichim
/// et al. 2017, sections 5 and 6; phace.md sections 5 and 6).
#pragma once

#include "phiz/elasticity/tissue_inverse.h"
#include "phiz/face/activation.h"

namespace phiz {

struct ActivationFitOptions {
  bool contact = true;
  ContactOptions contact_options;
  InverseOptions inverse = {.prior = {.direction = 0.1, .excess = 1000}, .max_iterations = 25, .tolerance = 1e-2};
};

struct ActivationFit {
  ActivationShape shape;
  VectorXd contractions;   ///< per muscle of the head: length of its fibres, 1 at rest
  double start = 0;        ///< root mean square distance from the expression's skin under the estimate, metres
  double distance = 0;     ///< the same under the fit
  bool converged = false;  ///< no step would lower the objective by a hundredth any more
  int iterations = 0;
};

/// The head's muscles as the muscle prior takes them, over tissue.body.
std::vector<MuscleFibres> muscle_fibres(const HeadTemplate& head, const HeadTissue& tissue);

/// Fits the activations of an expression, from an estimate of them and in its pose of the jaw. The skin that it should
/// have is that of its volumetric shape. Throws phiz::Error(bad_input) for a shape without displacement and for an
/// estimate that is not of this model, and as find_activations() does.
ActivationFit fit_activation(const FaceModel& model, const HeadTissue& tissue, const VolumetricShape& shape,
                             const ActivationShape& estimate, const ActivationFitOptions& options = {});

}  // namespace phiz
