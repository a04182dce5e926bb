// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/render/head_quantities.h"

#include <fmt/format.h>

#include "phiz/core/error.h"
#include "phiz/geometry/operators.h"
#include "phiz/geometry/spatial_query.h"
#include "phiz/geometry/topology.h"

namespace phiz {

namespace {

constexpr double millimetres = 1000;

void check(const Take& take, const TakeFrame& frame) {
  if (frame.skin.rows() != take.skin.V.rows())
    reject("take", fmt::format("a frame has {} skin vertices, the skin {}", frame.skin.rows(), take.skin.V.rows()),
           "animate again");
}

}  // namespace

VectorXd skin_displacement(const Take& take, const TakeFrame& frame) {
  check(take, frame);
  return millimetres * (frame.skin.cast<double>() - take.skin.V).rowwise().norm();
}

VectorXd skin_speed(const TakeFrame& before, const TakeFrame& now) {
  if (before.skin.rows() != now.skin.rows())
    reject("take", fmt::format("two frames have {} and {} skin vertices", before.skin.rows(), now.skin.rows()),
           "animate again");
  const double seconds = std::abs(now.time - before.time);
  if (!(seconds > 0)) return VectorXd::Zero(now.skin.rows());
  return millimetres / seconds * (now.skin - before.skin).cast<double>().rowwise().norm();
}

VectorXd skin_stretch(const Take& take, const TakeFrame& frame) {
  check(take, frame);
  const VectorXd rest = lumped_triangle_mass(take.skin.V, take.skin.F),
                 now = lumped_triangle_mass(frame.skin.cast<double>(), take.skin.F);
  return rest.binaryExpr(now, [](double r, double n) { return r > 0 ? 100 * (n / r - 1) : 0.0; });
}

VectorXd flesh_thickness(const HeadTemplate& head) {
  const MatrixX3i skull = region_boundary(head.volume, Tissue::skull),
                  mandible = region_boundary(head.volume, Tissue::mandible);
  MatrixX3i bones(skull.rows() + mandible.rows(), 3);
  bones << skull, mandible;
  const SurfaceQuery query(head.volume.V, bones);
  const auto nearest = query.closest_points(head.skin.V);
  VectorXd thickness(head.skin.V.rows());
  for (Eigen::Index i = 0; i < thickness.size(); ++i)
    thickness[i] = millimetres * std::sqrt(nearest[static_cast<std::size_t>(i)].squared_distance);
  return thickness;
}

}  // namespace phiz
