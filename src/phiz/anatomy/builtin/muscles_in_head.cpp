// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "phiz/anatomy/builtin/expressions/skin.h"
#include "phiz/anatomy/builtin/muscles.h"
#include "phiz/core/parallel.h"
#include "phiz/geometry/spatial_query.h"

namespace phiz {
namespace {

constexpr double deepest = 0.014;  ///< metres below the skin

/// Skin that is not the outside of the face.
const std::vector<std::string> inner_skin = {"mouthBag",      "oralRoof",   "oralFloor",   "upperLipInner",
                                             "lowerLipInner", "leftSocket", "rightSocket", "leftNostril",
                                             "rightNostril",  "neckCap"};

/// The outside of the face and what lies under it (bones and inner skin), as a surface and as points.
struct Layers {
  SurfaceQuery skin;
  MatrixX3d floor;

  explicit Layers(const HeadTemplate& head) : skin(head.volume.V, outer_triangles(head)) {
    std::vector<char> under(static_cast<std::size_t>(head.volume.V.rows()), 0);
    for (Eigen::Index v = 0; v < head.carrier.size(); ++v)
      if (head.carrier[v] != static_cast<int>(Carrier::flesh)) under[static_cast<std::size_t>(v)] = 1;
    const std::vector<char> inner = simulation_mask(head, inner_skin);
    for (std::size_t i = 0; i < inner.size(); ++i) {
      const auto v = static_cast<std::size_t>(head.skin_vertices[static_cast<Eigen::Index>(i)]);
      under[v] = inner[i];  // carried skin (the neck cap) is no floor unless it is inner skin
    }
    floor.resize(std::count(under.begin(), under.end(), 1), 3);
    Eigen::Index row = 0;
    for (std::size_t v = 0; v < under.size(); ++v)
      if (under[v]) floor.row(row++) = head.volume.V.row(static_cast<Eigen::Index>(v));
  }

  static MatrixX3i outer_triangles(const HeadTemplate& head) {
    std::vector<char> inner(static_cast<std::size_t>(head.volume.V.rows()), 0);
    const std::vector<char> mask = simulation_mask(head, inner_skin);
    for (std::size_t i = 0; i < mask.size(); ++i)
      inner[static_cast<std::size_t>(head.skin_vertices[static_cast<Eigen::Index>(i)])] = mask[i];
    std::vector<int> kept;
    for (int f = 0; f < head.skin_triangles.rows(); ++f) {
      const auto t = head.skin_triangles.row(f);
      if (!inner[static_cast<std::size_t>(t[0])] && !inner[static_cast<std::size_t>(t[1])] &&
          !inner[static_cast<std::size_t>(t[2])])
        kept.push_back(f);
    }
    return head.skin_triangles(kept, Eigen::all);
  }

  /// The point under p at `depth` between floor (0) and skin (1).
  Vector3d settle(const Vector3d& p, double depth) const {
    Vector3d top = skin.closest_point(p).position;
    if (floor.rows() == 0) return top;
    Eigen::Index nearest = 0;
    (floor.rowwise() - top.transpose()).rowwise().squaredNorm().minCoeff(&nearest);
    const Vector3d down = floor.row(nearest).transpose() - top;
    return top + down * std::min(1.0, deepest / std::max(down.norm(), 1e-9)) * (1 - depth);
  }
};

}  // namespace

void settle_muscles(std::vector<MuscleBundle>& muscles, const HeadTemplate& head) {
  const Layers layers(head);
  parallel_for(
      static_cast<std::ptrdiff_t>(muscles.size()),
      [&](std::ptrdiff_t m) {
        MuscleBundle& bundle = muscles[static_cast<std::size_t>(m)];
        if (bundle.placed) return;
        for (MatrixX3d& fibre : bundle.fibres) {
          const Eigen::Index last = fibre.rows() - 1;
          for (Eigen::Index i = 0; i <= last; ++i) {
            const double t = double(i) / static_cast<double>(last);
            const double depth = (1 - t) * bundle.origin_depth + t * bundle.insertion_depth;
            fibre.row(i) = layers.settle(fibre.row(i), depth).transpose();
          }
          const bool closed = (fibre.row(0) - fibre.row(last)).norm() < 1e-9;
          for (int pass = 0; pass < 3; ++pass) {
            const MatrixX3d before = fibre;
            for (Eigen::Index i = 1; i < last; ++i)
              fibre.row(i) = 0.5 * before.row(i) + 0.25 * (before.row(i - 1) + before.row(i + 1));
            if (closed)
              fibre.row(0) = fibre.row(last) = 0.5 * before.row(0) + 0.25 * (before.row(1) + before.row(last - 1));
          }
        }
      },
      1);
}

}  // namespace phiz
