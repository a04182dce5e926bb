// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "phiz/core/error.h"
#include "phiz/render/heat_map.h"
#include "render/shapes.h"

namespace phiz {
namespace {

/// Perceived lightness of OKLab for linear RGB.
double lightness(const Vector3d& c) {
  const double l = 0.4122214708 * c.x() + 0.5363325363 * c.y() + 0.0514459929 * c.z();
  const double m = 0.2119034982 * c.x() + 0.6806995451 * c.y() + 0.1073969566 * c.z();
  const double s = 0.0883024619 * c.x() + 0.2817188376 * c.y() + 0.6299787005 * c.z();
  return 0.2104542553 * std::cbrt(l) + 0.7936177850 * std::cbrt(m) - 0.0040720468 * std::cbrt(s);
}

TEST(HeatMap, SequentialMapRisesEvenlyInLightness) {
  for (int i = 0; i < 100; ++i) {
    const double step = lightness(map_colour(ColourMap::sequential, (i + 1) / 100.0)) -
                        lightness(map_colour(ColourMap::sequential, i / 100.0));
    EXPECT_NEAR(step, 0.0065, 0.003) << i;
  }
}

TEST(HeatMap, DivergingMapIsWhiteInTheMiddleAndFallsToBothSides) {
  const Vector3d middle = map_colour(ColourMap::diverging, 0.5);
  EXPECT_NEAR(middle.x(), middle.z(), 0.02);
  for (int i = 0; i < 50; ++i) {
    EXPECT_LT(lightness(map_colour(ColourMap::diverging, i / 100.0)),
              lightness(map_colour(ColourMap::diverging, (i + 1) / 100.0)));
    EXPECT_GT(lightness(map_colour(ColourMap::diverging, 0.5 + i / 100.0)),
              lightness(map_colour(ColourMap::diverging, 0.5 + (i + 1) / 100.0)));
  }
}

TEST(HeatMap, ScaleFitsTheValues) {
  const HeatScale one_sided = fit_heat_scale(VectorXd::LinSpaced(10, 0, 3.7), "displacement", "mm");
  EXPECT_EQ(one_sided.low, 0);
  EXPECT_EQ(one_sided.high, 4);
  EXPECT_EQ(one_sided.map, ColourMap::sequential);
  const HeatScale both = fit_heat_scale(VectorXd::LinSpaced(10, -0.8, 0.3), "offset", "mm");
  EXPECT_EQ(both.low, -both.high);
  EXPECT_EQ(both.map, ColourMap::diverging);
  const HeatScale zero = fit_heat_scale(VectorXd::Zero(4), "penetration", "mm");
  EXPECT_GT(zero.high, zero.low);
  EXPECT_THROW(fit_heat_scale(VectorXd::Constant(3, std::nan("")), "x", ""), Error);
}

TEST(HeatMap, PaintsVerticesByValue) {
  Surface ball = test::surface_of(test::sphere(1, 2));
  const HeatScale scale{"height", "m", -1, 1, ColourMap::diverging};
  paint_heat(ball, ball.mesh.V.col(1), scale);
  for (Eigen::Index i = 0; i < ball.mesh.V.rows(); ++i)
    EXPECT_LT((ball.colour.row(i).transpose() - map_colour(scale.map, (ball.mesh.V(i, 1) + 1) / 2)).norm(), 1e-12);
  EXPECT_THROW(paint_heat(ball, VectorXd::Zero(3), scale), Error);
}

}  // namespace
}  // namespace phiz
