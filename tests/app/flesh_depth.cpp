// SPDX-License-Identifier: GPL-3.0-or-later
#include "flesh_depth.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "phiz/geometry/spatial_query.h"

namespace phiz::testing {

FleshDepth::FleshDepth(const HeadTemplate& head, OwnFlesh own)
    : flesh_(head.volume.T(soft_tets(head), Eigen::all)), skin_(head.skin_triangles) {
  std::set<int> chosen;
  for (const ContactRegion& region : head.contact_regions)
    chosen.insert(region.vertices.begin(), region.vertices.end());
  vertices_.assign(chosen.begin(), chosen.end());
  std::vector<std::set<int>> corners(static_cast<std::size_t>(head.volume.V.rows()));
  for (Eigen::Index t = 0; t < flesh_.rows(); ++t)
    for (int k = 0; k < 4; ++k)
      for (int l = 0; l < 4; ++l) corners[static_cast<std::size_t>(flesh_(t, k))].insert(flesh_(t, l));
  for (const int v : vertices_) {
    const std::set<int>& around = corners[static_cast<std::size_t>(v)];
    surroundings_.emplace_back(own == OwnFlesh::tets ? std::vector<int>{v}
                                                     : std::vector<int>(around.begin(), around.end()));
  }
}

double FleshDepth::deepest(const MatrixX3d& V) const {
  const TetQuery tets(V, flesh_);
  const SurfaceQuery surface(V, skin_);
  double most = 0;
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    const Vector3d p = V.row(vertices_[i]);
    const auto place = tets.locate(p);
    if (!place) continue;
    const auto is_own = [&](int v) { return std::binary_search(surroundings_[i].begin(), surroundings_[i].end(), v); };
    bool own = false;
    for (int k = 0; k < 4; ++k) own = own || is_own(flesh_(place->tet, k));
    if (own) continue;
    constexpr double reach = 0.004;
    double nearest = reach;
    for (const int f : surface.triangles_in_box(p.array() - reach, p.array() + reach)) {
      if ((skin_.row(f).array() == vertices_[i]).any()) continue;
      const Vector3d a = V.row(skin_(f, 0)), b = V.row(skin_(f, 1)), c = V.row(skin_(f, 2));
      const Vector3d w = closest_barycentric(p, a, b, c);
      nearest = std::min(nearest, (p - w[0] * a - w[1] * b - w[2] * c).norm());
    }
    most = std::max(most, nearest);
  }
  return most;
}

}  // namespace phiz::testing
