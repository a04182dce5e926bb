// SPDX-License-Identifier: GPL-3.0-or-later
/// The part of orbicularis oculi that closes the eye.
#pragma once

#include "phiz/anatomy/head_template.h"

namespace phiz {

/// Lets orbicularis oculi reach the margins of the lids: its pretarsal part, a layer too thin for surfaces of muscles,
/// fills more than half of a lid. To be called when contact regions and muscles are there.
void extend_muscles_to_lids(HeadTemplate& head);

}  // namespace phiz
