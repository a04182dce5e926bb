// SPDX-License-Identifier: GPL-3.0-or-later
/// A head with another skin, under which everything else follows: tets, bones, teeth, muscles, expressions.
#pragma once

#include "phiz/anatomy/head_template.h"

namespace phiz {

/// Gives `head` the drawn skin `skin` (n_skin x 3, vertex by vertex, in the same frame) and takes everything along:
///
/// * bones, teeth, eyes, tongue and joint follow a smooth map of space that fits the skin's displacement (radial
///   functions, as in the registration of anatomy, Ichim et al. 2017, section 5.3.2); the simulated bones keep 1.2 mm
///   from the skin; eyes stay round and as far from their lids as they were;
/// * the tets keep their topology: the simulation skin and the bones are where they should be, what lies between
///   follows harmonically and is smoothed. Muscles, attachments, contacts and maps keep their rows, so that what was
///   computed for one head holds for the other;
/// * displacements of expressions are turned and stretched as the skin about them is; what the jaw moves turns about
///   the new joint;
/// * the frame moves so that its origin is midway between the condyles. `identity` is left empty: a person has none.
///
/// Throws phiz::Error(usage) on a skin of another size, phiz::Error(bad_input) when skin_vertices are not those of
/// skin_triangles in ascending order, when the new skin cannot be freed of
/// self-intersections or is so different that tets stay inverted.
HeadTemplate reshape_head(const HeadTemplate& head, const MatrixX3d& skin);

}  // namespace phiz
