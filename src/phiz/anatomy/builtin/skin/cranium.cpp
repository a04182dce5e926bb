// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/skin/cranium.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace phiz {
namespace {

/// Two half ellipses that share their widest place.
struct CraniumSection {
  double y, half_width, z_widest, front, back;
};
/// From the cut of the neck to where the vault begins; above the neck the front halves lie inside the face.
constexpr CraniumSection sections[] = {
    {-170, 64.5, -45, 49.5, 61.5}, {-140, 58.8, -39, 52.5, 55.5}, {-116, 55.8, -36.5, 57, 51},
    {-95, 54, -36, 64, 47},        {-80, 53.8, -36, 70, 45.8},    {-65, 54.8, -35.5, 80, 46},
    {-50, 57, -34.5, 85, 48},      {-35, 60.3, -33, 90, 52},      {-20, 63.8, -31, 95, 58.5},
    {-5, 66.8, -29, 98, 66.5},     {10, 69.6, -27.5, 99, 74.5},   {25, 72.3, -26.5, 100, 81},
    {40, 74.5, -26, 100.5, 84.5},  {55, 75.5, -26, 100.5, 85},
};
constexpr int section_count = static_cast<int>(std::size(sections));
constexpr double vault_foot = 55, crown = 140;

/// Catmull-Rom over the height.
CraniumSection section_at(double y) {
  if (y >= vault_foot) return sections[section_count - 1];
  int k = 0;
  while (k + 2 < section_count && sections[k + 1].y <= y) ++k;
  const auto value = [&](int i, double CraniumSection::*of) {
    return sections[std::clamp(i, 0, section_count - 1)].*of;
  };
  const auto at = [&](double CraniumSection::*of) {
    const auto slope = [&](int i) {
      const double dy = value(i + 1, &CraniumSection::y) - value(i - 1, &CraniumSection::y);
      return i + 1 == section_count ? 0.0 : (value(i + 1, of) - value(i - 1, of)) / dy;
    };
    const double h = sections[k + 1].y - sections[k].y, t = (y - sections[k].y) / h, t2 = t * t, t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * value(k, of) + (t3 - 2 * t2 + t) * h * slope(k) +
           (3 * t2 - 2 * t3) * value(k + 1, of) + (t3 - t2) * h * slope(k + 1);
  };
  return {y, at(&CraniumSection::half_width), at(&CraniumSection::z_widest), at(&CraniumSection::front),
          at(&CraniumSection::back)};
}

/// The vault's meridians are superellipses, fuller in front; `forward`: cosine of the angle from the front.
double exponent(double forward) {
  return 2.14 + 0.13 * forward;
}

/// How far out p lies, as a share of the section's size in its direction.
double reach(const CraniumSection& s, double x, double z, double& forward) {
  const double a = x / s.half_width, b = (z - s.z_widest) / (z > s.z_widest ? s.front : s.back);
  const double r = std::hypot(a, b);
  forward = r > 1e-12 ? b / r : 0;
  return r;
}

}  // namespace

Vector3d cranium_point(double angle, double y) {
  const double a = angle * std::numbers::pi / 180;
  const CraniumSection s = section_at(y);
  double share = 1;
  if (y > vault_foot) {
    const double m = exponent(std::cos(a)), rise = std::min(1.0, (y - vault_foot) / (crown - vault_foot));
    share = std::pow(1 - std::pow(rise, m), 1 / m);
  }
  return {share * s.half_width * std::sin(a), y,
          s.z_widest + share * (std::cos(a) > 0 ? s.front : s.back) * std::cos(a)};
}

Vector3d cranium_under(const Vector3d& p) {
  double forward = 0;
  const Vector3d middle(0, vault_foot, sections[section_count - 1].z_widest);
  if (p.y() <= vault_foot) {
    const CraniumSection s = section_at(p.y());
    const double r = reach(s, p.x(), p.z(), forward);
    return {p.x() / r, p.y(), s.z_widest + (p.z() - s.z_widest) / r};
  }
  const double r = reach(sections[section_count - 1], p.x(), p.z(), forward), m = exponent(forward);
  const double level = std::pow(std::pow(r, m) + std::pow((p.y() - vault_foot) / (crown - vault_foot), m), 1 / m);
  return middle + (p - middle) / level;
}

double cranium_half_width(double y, double z) {
  const CraniumSection s = section_at(y);
  const double b = (z - s.z_widest) / (z > s.z_widest ? s.front : s.back);
  return s.half_width * std::sqrt(std::max(0.0, 1 - b * b));
}

double vault_height(double x, double z) {
  double forward = 0;
  const double r = reach(sections[section_count - 1], x, z, forward), m = exponent(forward);
  return vault_foot + (crown - vault_foot) * std::pow(std::max(0.0, 1 - std::pow(r, m)), 1 / m);
}

}  // namespace phiz
