// SPDX-License-Identifier: GPL-3.0-or-later
/// Local changes of a tet complex. Each is kept only where the worst tet concerned becomes better, and returns whether
/// it was. Surfaces are kept.
#pragma once

#include "phiz/geometry/tet_complex.h"

namespace phiz {

/// Gains of quality smaller than this do not count.
inline constexpr double least_gain = 1e-4;

/// Moves the vertex to where the worst tet round it is best (Freitag and Ollivier-Gooch 1997): steps along the shortest
/// vector in the hull of the gradients of the worst ones.
bool smooth_vertex(TetComplex& complex, int v);

/// Replaces the n tets round an edge inside of a region by 2n - 4 that lack it: the best triangulation of the ring by
/// dynamic programming (Klincsek 1980; Shewchuk 2002).
bool remove_edge(TetComplex& complex, int a, int b);

/// Replaces the pairs of tets on both sides of a patch of faces by tets round the edge between their two apexes; the
/// patch grows from the face of tet t opposite to corner k where that helps (Shewchuk 2002). The inverse of
/// remove_edge.
bool remove_faces(TetComplex& complex, int t, int k);

/// Merges a vertex inside of a region into a neighbour.
bool contract_edge(TetComplex& complex, int inner, int into);

/// Puts a new vertex into the tet and connects it with the faces of a cavity that grows over neighbours as long as that
/// helps (Klingner and Shewchuk 2007), then improves what lies round it.
bool insert_vertex(TetComplex& complex, int t);

}  // namespace phiz
