// SPDX-License-Identifier: GPL-3.0-or-later
/// "First light": ten seconds of a face that says a sentence, smiles, is surprised, frowns, swings its jaw, throws a
/// kiss, and winks.
#pragma once

#include "phiz/face/performance.h"

namespace phiz::authoring {

/// The performance at `frame_rate` frames per second, with all of ARKit's expressions as columns.
Performance first_light(double frame_rate);

}  // namespace phiz::authoring
