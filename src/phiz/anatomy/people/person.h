// SPDX-License-Identifier: GPL-3.0-or-later
/// People from the statistical model of a head (HeadTemplate::identity).
#pragma once

#include <cstdint>

#include "phiz/anatomy/head_template.h"

namespace phiz {

/// Coefficients of a plausible person: independent normal deviates, drawn again where they are beyond 2. The same for
/// the same seed on every machine.
VectorXd random_coefficients(const IdentityModel& model, std::uint64_t seed);

/// The drawn skin of the person with these coefficients, one per mode, in standard deviations. Throws
/// phiz::Error(usage) when their number is not that of the modes, or one is not finite.
MatrixX3d person_skin(const HeadTemplate& head, const VectorXd& coefficients);

/// The head of a person, anatomy included: reshape_head to the person's skin. Throws phiz::Error(bad_input) when the
/// head has no modes, and as reshape_head does.
HeadTemplate make_person(const HeadTemplate& head, const VectorXd& coefficients);

}  // namespace phiz
