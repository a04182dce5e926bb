// SPDX-License-Identifier: GPL-3.0-or-later
/// Quantities per vertex of the drawn skin for heat maps.
#pragma once

#include "phiz/anatomy/head_template.h"
#include "phiz/face/take.h"

namespace phiz {

/// Distance of every skin vertex from its rest position in the head frame, millimetres.
VectorXd skin_displacement(const Take& take, const TakeFrame& frame);

/// Speed in the head frame between a frame and the one before, millimetres per second; zero for the first.
VectorXd skin_speed(const Take& take, std::size_t frame);

/// Relative change of the area of skin round every vertex, per cent.
VectorXd skin_stretch(const Take& take, const TakeFrame& frame);

/// Distance from every skin vertex to the nearest bone (boundary of the skull and mandible tets), millimetres.
VectorXd flesh_thickness(const HeadTemplate& head);

}  // namespace phiz
