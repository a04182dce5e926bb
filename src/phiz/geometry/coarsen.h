// SPDX-License-Identifier: GPL-3.0-or-later
/// Coarser triangulations whose edge length varies over the surface.
#pragma once

#include <functional>

#include "phiz/geometry/mesh.h"

namespace phiz {

struct CoarsenOptions {
  /// Wanted edge length at a point, metres. Where it is shorter than the edges of the surface these stay as they are.
  std::function<double(const Vector3d&)> edge_length;
  /// Where the body behind the surface is thin, edges are no longer than this many times its thickness; 0: no limit.
  double slenderness = 0;
  int rounds = 8;  ///< of collapsing, flipping and relaxing
};

/// Remeshes a closed manifold surface by edge collapses, flips and tangential relaxation (after Botsch and Kobbelt
/// 2004 and Dunyach et al. 2013); all vertices lie on `fine`. Same genus, deterministic. Sheets that lie close to each
/// other stay apart as far as the wanted length allows: check self_intersections.
TriangleMesh coarsen(const TriangleMesh& fine, const CoarsenOptions& options);

}  // namespace phiz
