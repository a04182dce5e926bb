// SPDX-License-Identifier: GPL-3.0-or-later
/// Muscles of a head from their shapes: what share of each tet they fill and which way they pull there.
#pragma once

#include <span>
#include <vector>

#include "phiz/anatomy/fibre_field.h"
#include "phiz/anatomy/head_template.h"

namespace phiz {

/// Tets, fractions and directions of one muscle in the flesh tets of `volume` (tags: Tissue). Each tet is sampled at
/// the centres of a regular subdivision, 35 to 364 points no more than about 0.8 mm apart: the fraction of a tet that a
/// plane or a sphere cuts is off by less than 0.06 at worst and 0.015 on average, the volume of a muscle by less than
/// 1 % (tests/anatomy/test_fibres.cpp). The direction is the dominant one of the samples inside.
void fill_muscle(Muscle& muscle, const TetMesh& volume, const FibreField& field);

/// The muscles in the order of their shapes, complete: surface (the shape's own where it is a closed manifold, else
/// that of its voxels), tets, fractions, directions and traced fibres. Where muscles overlap, or a surface reaches out
/// of the flesh, the fractions are scaled so that their sum in a tet is at most 1. Throws as FibreField does.
std::vector<Muscle> make_muscles(const TetMesh& volume, std::span<const MuscleShape> shapes,
                                 const FibreOptions& options = {});

/// The share of a closed surface's volume that lies in flesh tets, counted on voxels of 0.7 mm.
double share_in_flesh(const TetMesh& volume, const TriangleMesh& surface);

}  // namespace phiz
