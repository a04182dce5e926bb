// SPDX-License-Identifier: GPL-3.0-or-later
/// Quantities per vertex of the drawn skin for heat maps.
#pragma once

#include "phiz/anatomy/head_template.h"
#include "phiz/face/take.h"

namespace phiz {

/// Distance of every skin vertex from its rest position in the head frame, millimetres.
VectorXd skin_displacement(const Take& take, const TakeFrame& frame);

/// Speed in the head frame between two frames, millimetres per second; zero when their times are the same.
VectorXd skin_speed(const TakeFrame& before, const TakeFrame& now);

/// Relative change of the area of skin round every vertex, per cent.
VectorXd skin_stretch(const Take& take, const TakeFrame& frame);

/// How deep every skin vertex lies inside the teeth (parts whose name contains "eeth"), millimetres; zero outside.
VectorXd teeth_penetration(const Take& take, const TakeFrame& frame);

/// Distance from every skin vertex to the nearest bone (boundary of the skull and mandible tets), millimetres.
VectorXd flesh_thickness(const HeadTemplate& head);

}  // namespace phiz
