// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/mouth/dentition.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace phiz {
namespace {

constexpr double contour = 0.28;       ///< share of the height at which the labial face stands out most
constexpr double neck_depth = 0.9e-3;  ///< by which the neck lies behind it, metres

constexpr std::array<Cusp, 2> upper_premolar{{{0, 0.50, 1.0}, {-0.10, -0.55, 0.90}}};
constexpr std::array<Cusp, 4> upper_molar{
    {{-0.48, 0.58, 1.0}, {0.46, 0.58, 0.97}, {-0.40, -0.55, 0.99}, {0.50, -0.62, 0.90}}};
constexpr std::array<Cusp, 2> lower_first_premolar{{{0, 0.40, 1.0}, {-0.05, -0.66, 0.74}}};
constexpr std::array<Cusp, 3> lower_second_premolar{{{0, 0.46, 1.0}, {-0.38, -0.60, 0.90}, {0.42, -0.60, 0.86}}};
constexpr std::array<Cusp, 5> lower_first_molar{
    {{-0.56, 0.55, 0.96}, {0.12, 0.60, 0.95}, {0.72, 0.30, 0.88}, {-0.50, -0.60, 1.0}, {0.42, -0.60, 0.98}}};
constexpr std::array<Cusp, 4> lower_second_molar{
    {{-0.50, 0.56, 0.97}, {0.46, 0.56, 0.95}, {-0.50, -0.58, 1.0}, {0.46, -0.58, 0.98}}};

}  // namespace

// Crown sizes after the means of Wheeler's Dental Anatomy.
const HalfDentition& upper_dentition() {
  static const HalfDentition teeth{{
      {8.6, 7.0, 10.5, 0.0, 0.83, 0.86, 0.86, 0.68, 0.88, 0.74, 2.8, 0.15, 0.5, 0.09, 2.5},
      {6.8, 6.0, 9.2, 0.8, 0.83, 0.82, 0.76, 0.60, 0.78, 0.60, 2.3, 0.16, 0.5, 0.09, 2.4},
      {7.7, 8.0, 10.2, 0.2, 0.83, 0.88, 0.66, 0.54, 0.24, 0.22, 1.35, 0.20, 1.0, 0.08, 2.1},
      {7.1, 9.0, 8.6, 0.7, 0.79, 0.88, 0.56, 0.54, 0.66, 0.66, 1.6, 0.66, 1.1, 0.04, 2.3, upper_premolar},
      {6.9, 9.0, 8.4, 0.9, 0.80, 0.88, 0.56, 0.54, 0.68, 0.68, 1.7, 0.66, 1.1, 0.03, 2.4, upper_premolar},
      {10.4, 10.8, 7.6, 1.1, 0.85, 0.88, 0.62, 0.56, 0.80, 0.78, 2.2, 0.70, 1.0, 0.02, 2.9, upper_molar},
      {9.6, 10.6, 7.2, 1.5, 0.85, 0.88, 0.60, 0.54, 0.78, 0.72, 2.2, 0.70, 1.0, 0.02, 2.8, upper_molar},
  }};
  return teeth;
}

const HalfDentition& lower_dentition() {
  static const HalfDentition teeth{{
      {5.3, 5.8, 9.0, 0.0, 0.79, 0.90, 0.86, 0.84, 0.93, 0.91, 3.0, 0.18, 1.1, 0.04, 2.3},
      {5.8, 6.2, 9.3, 0.1, 0.79, 0.90, 0.84, 0.80, 0.92, 0.84, 2.8, 0.18, 1.1, 0.04, 2.3},
      {7.0, 7.5, 10.6, 0.0, 0.85, 0.90, 0.72, 0.60, 0.26, 0.22, 1.4, 0.20, 1.2, 0.04, 2.1},
      {7.1, 7.8, 8.8, 0.8, 0.81, 0.86, 0.60, 0.58, 0.60, 0.60, 1.5, 0.58, 1.9, 0, 2.2, lower_first_premolar},
      {7.2, 8.3, 8.3, 1.2, 0.83, 0.88, 0.60, 0.58, 0.70, 0.70, 1.8, 0.64, 1.8, -0.04, 2.4, lower_second_premolar},
      {11.0, 10.2, 7.6, 1.3, 0.89, 0.88, 0.64, 0.58, 0.80, 0.74, 2.2, 0.68, 1.9, -0.10, 2.9, lower_first_molar},
      {10.5, 10.0, 7.2, 0.9, 0.89, 0.88, 0.62, 0.56, 0.78, 0.76, 2.2, 0.68, 1.9, -0.12, 3.0, lower_second_molar},
  }};
  return teeth;
}

std::array<ToothPlace, 7> tooth_places(const ArchCurve& arch, const HalfDentition& teeth) {
  constexpr int steps = 400;
  VectorXd inner(steps + 1);  // length of the curve on which crowns touch, up to evenly spaced places of the outline
  inner(0) = 0;
  const auto at = [&](int i) -> Vector2d {
    const double s = arch.length() * i / steps;
    return arch.point(s) - contact_depth * arch.outward(s);
  };
  for (int i = 1; i <= steps; ++i) inner(i) = inner(i - 1) + (at(i) - at(i - 1)).norm();
  double total = 0;
  for (const ToothForm& t : teeth) total += t.width;
  const double scale = inner(steps) / total;
  const auto outline = [&](double length) {
    const auto above = std::upper_bound(inner.begin(), inner.end() - 1, length);
    const auto i = std::max<Eigen::Index>(above - inner.begin(), 1);
    return arch.length() * (static_cast<double>(i - 1) + (length - inner(i - 1)) / (inner(i) - inner(i - 1))) / steps;
  };
  std::array<ToothPlace, 7> places;
  double from = 0;
  for (std::size_t i = 0; i < teeth.size(); ++i) {
    const double width = scale * teeth[i].width;
    places[i] = {outline(from), outline(from + 0.5 * width), outline(from + width), width};
    from += width;
  }
  return places;
}

double labial_depth(const ToothForm& tooth, double share) {
  const double mm = 1e-3, height = tooth.height * mm;
  const double lean = tooth.lean > 0 ? tooth.lean * (1 - share) * height : -tooth.lean * std::max(0.0, share) * height;
  if (share < contour) {
    const double t = std::clamp(share / contour, -2.0, 1.0);
    return lean + neck_depth * (t < 0 ? 1 - 0.6 * t : 1 - std::sin(0.5 * std::numbers::pi * t));
  }
  const double t = (share - contour) / (1 - contour);
  return lean + tooth.labial_fall * mm * t * t;
}

}  // namespace phiz
