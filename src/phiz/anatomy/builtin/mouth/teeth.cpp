// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/mouth/teeth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "phiz/anatomy/builtin/mouth/dental_arch.h"
#include "phiz/anatomy/builtin/mouth/loft.h"

namespace phiz {
namespace {

enum class Kind { incisor, canine, premolar, molar };

/// Crown measures in millimetres; `short_by`: how far the edge stays behind that of the central incisor.
struct ToothSize {
  Kind kind;
  double width;      ///< along the arch
  double thickness;  ///< across the arch
  double short_by;
};
using HalfArch = std::array<ToothSize, 7>;

constexpr HalfArch upper_sizes{{{Kind::incisor, 8.6, 6.6, 0.0},
                                {Kind::incisor, 6.8, 6.0, 0.9},
                                {Kind::canine, 7.6, 7.6, 0.1},
                                {Kind::premolar, 7.0, 8.6, 1.0},
                                {Kind::premolar, 6.8, 8.8, 1.2},
                                {Kind::molar, 10.2, 10.4, 1.4},
                                {Kind::molar, 9.6, 10.2, 1.4}}};
constexpr HalfArch lower_sizes{{{Kind::incisor, 5.4, 5.6, 0.0},
                                {Kind::incisor, 5.9, 5.9, 0.2},
                                {Kind::canine, 6.9, 7.0, -0.1},
                                {Kind::premolar, 7.1, 7.6, 0.8},
                                {Kind::premolar, 7.1, 8.0, 1.1},
                                {Kind::molar, 11.0, 9.6, 1.3},
                                {Kind::molar, 10.4, 9.6, 1.3}}};

/// One level of a crown: `height` from the neck (0) to the edge (1), half width and half thickness as shares of the
/// tooth's, and where the labial face is (share of the half thickness).
struct Level {
  double height, width, thickness, labial;
};

constexpr std::array<Level, 10> incisor_levels{{{-0.70, 0.30, 0.42, 0.55},
                                                {-0.35, 0.56, 0.72, 0.78},
                                                {0.00, 0.76, 0.90, 0.88},
                                                {0.15, 0.85, 0.96, 0.97},
                                                {0.35, 0.94, 0.82, 1.00},
                                                {0.55, 0.985, 0.62, 0.99},
                                                {0.75, 1.00, 0.42, 0.95},
                                                {0.90, 0.99, 0.29, 0.90},
                                                {0.97, 0.965, 0.22, 0.86},
                                                {1.00, 0.90, 0.13, 0.81}}};
constexpr std::array<Level, 10> canine_levels{{{-0.75, 0.30, 0.42, 0.50},
                                               {-0.35, 0.60, 0.76, 0.78},
                                               {0.00, 0.78, 0.90, 0.88},
                                               {0.15, 0.87, 0.98, 0.97},
                                               {0.35, 0.95, 0.88, 1.00},
                                               {0.55, 1.00, 0.70, 0.98},
                                               {0.72, 0.97, 0.52, 0.92},
                                               {0.86, 0.80, 0.38, 0.85},
                                               {0.95, 0.48, 0.26, 0.79},
                                               {1.00, 0.17, 0.14, 0.73}}};
constexpr std::array<Level, 10> grinder_levels{{{-0.75, 0.50, 0.55, 0.50},
                                                {-0.35, 0.72, 0.76, 0.75},
                                                {0.00, 0.84, 0.86, 0.88},
                                                {0.20, 0.93, 0.96, 0.98},
                                                {0.42, 1.00, 1.00, 1.00},
                                                {0.65, 0.99, 0.96, 0.95},
                                                {0.82, 0.95, 0.86, 0.86},
                                                {0.93, 0.84, 0.72, 0.74},
                                                {0.97, 0.52, 0.44, 0.46},
                                                {0.98, 0.22, 0.19, 0.20}}};

/// Height of the biting surface of a premolar or molar above its mean, in shares of the crown's height; (u, v) in
/// [-1, 1] along and across the arch.
double cusps(Kind kind, double u, double v) {
  const auto bump = [u, v](double cu, double cv, double sharp) {
    return std::exp(-sharp * ((u - cu) * (u - cu) + (v - cv) * (v - cv)));
  };
  if (kind == Kind::premolar) return 0.24 * bump(0, 0.58, 4) + 0.17 * bump(0, -0.58, 4) - 0.12;
  if (kind == Kind::molar) {
    return 0.20 * (bump(-0.52, 0.58, 5.5) + bump(0.52, 0.58, 5.5) + bump(-0.5, -0.58, 5.5) + bump(0.5, -0.56, 5.5)) -
           0.13;
  }
  return 0;
}

/// One tooth in its own frame, unit-free shares resolved: x along the arch, y from the neck to the edge, z labial, with
/// the labial face at z = 0 at its most prominent level.
TriangleMesh make_tooth(const ToothSize& size, double width, double thickness, double height) {
  const bool grinder = size.kind == Kind::premolar || size.kind == Kind::molar;
  const auto& levels = grinder ? grinder_levels : size.kind == Kind::canine ? canine_levels : incisor_levels;
  const double squareness = size.kind == Kind::molar ? 3.0 : size.kind == Kind::premolar ? 2.4 : 2.3;
  constexpr int sectors = 20;
  std::vector<MatrixX3d> rings;
  for (const Level& level : levels) {
    MatrixX3d ring(sectors, 3);
    const double half_width = 0.5 * width * level.width, half_thickness = 0.5 * thickness * level.thickness;
    const double middle = 0.5 * thickness * (level.labial - 1) - half_thickness;
    for (int i = 0; i < sectors; ++i) {
      const double a = 2 * std::numbers::pi * i / sectors;
      const double c = std::cos(a), s = std::sin(a);
      const double r = std::pow(std::pow(std::abs(c), squareness) + std::pow(std::abs(s), squareness), -1 / squareness);
      const double u = r * c * level.width, v = r * s * level.thickness;
      // The neck follows the gum: it dips between the teeth. The biting surface has cusps.
      const double at_neck = std::exp(-std::pow(level.height / 0.2, 2));
      double y = level.height + 0.10 * at_neck * (c * c - 0.5);
      if (grinder) y += cusps(size.kind, u, v) * std::clamp((level.height - 0.6) / 0.35, 0.0, 1.0);
      // Incisal edges are convex seen from the front and lie on a gentle curve.
      if (size.kind == Kind::incisor && level.height > 0.9) y -= 0.02 * c * c;
      ring.row(i) << half_width * r * c, height * y, middle + half_thickness * r * s;
    }
    rings.push_back(ring);
  }
  return loft(rings);
}

/// Both halves of an arch. `up`: +1 when crowns grow upwards. Heights in metres.
TriangleMesh make_teeth(const ArchCurve& arch, const HalfArch& sizes, double gum, double edge) {
  double total = 0;
  for (const ToothSize& t : sizes) total += t.width;
  // The widths are measured a little inside of the labial outline, where neighbouring crowns touch.
  const double along = arch.length() / total;
  const double across = std::min(1.0, 1e3 * along * 1.06) * 1e-3;
  const double up = edge > gum ? 1.0 : -1.0;
  std::vector<TriangleMesh> all;
  double s = 0;
  for (const ToothSize& size : sizes) {
    const double width = along * size.width, thickness = across * size.thickness;
    const double height = std::abs(edge - gum) - 1e-3 * size.short_by;
    const double middle = s + 0.5 * width;
    s += width;
    const Vector2d tangent = arch.tangent(middle), outward = arch.outward(middle);
    // The chord across a crown lies inside of the curve; crowns on the strongly bent front are narrowed to fit.
    const double bend = std::abs(arch.outward(s).dot(arch.tangent(s - width)));
    const double squeeze = 1 - 0.5 * bend * thickness * 0.55 / width;
    TriangleMesh tooth = make_tooth(size, 0.985 * width * squeeze, thickness, height);
    const double lean = (size.kind == Kind::incisor || size.kind == Kind::canine) ? 0.10 : 0.03;
    // The labial face is flat across the tooth and the arch is curved: half the sagitta inwards.
    const double inset = 0.125 * width * bend + 0.0001;
    const Vector2d origin = arch.point(middle) - inset * outward;
    for (Eigen::Index i = 0; i < tooth.V.rows(); ++i) {
      const Vector3d q = tooth.V.row(i);
      const double z = q.z() - lean * std::abs(q.y() - 0.5 * height) * (q.y() < 0.5 * height ? 1.0 : 0.15);
      const Vector2d plane = origin + q.x() * tangent + z * outward;
      tooth.V.row(i) << plane.x(), gum + up * q.y(), plane.y();
    }
    if (up < 0) {  // the map above mirrors the crowns that grow downwards
      tooth.F.col(1).swap(tooth.F.col(2));
      tooth.FUV.col(1).swap(tooth.FUV.col(2));
    }
    all.push_back(tooth);
    all.push_back(mirrored(tooth));
  }
  return joined(all);
}

/// The band from the sulcus to the necks. `sulcus`: y of the hidden side.
TriangleMesh make_gums(const ArchCurve& arch, const HalfArch& sizes, double gum, double sulcus) {
  double total = 0;
  for (const ToothSize& t : sizes) total += t.width;
  const double along = arch.length() / total, up = gum > sulcus ? 1.0 : -1.0;
  std::vector<double> borders{0};
  for (const ToothSize& t : sizes) borders.push_back(borders.back() + along * t.width);
  constexpr int across_steps = 28;
  const double end = arch.length() + 0.004;
  constexpr int half_count = 70;
  std::vector<MatrixX3d> rings;
  for (int k = -half_count; k <= half_count; ++k) {
    const double side = k < 0 ? -1 : 1, s = end * std::abs(k) / half_count;
    // How far between two teeth: 0 at the middle of a crown, 1 at a papilla.
    const auto next = std::upper_bound(borders.begin() + 1, borders.end() - 1, s);
    const double low = next[-1], high = *next;
    const double papilla = s > high ? 0.0 : std::pow(std::abs(2 * (s - low) / (high - low) - 1), 2.2);
    const double molar = std::clamp(s / arch.length(), 0.0, 1.0);
    const double thickness = 0.0080 + 0.0038 * std::pow(molar, 1.5);
    const double closing = std::sqrt(std::max(0.02, 1 - std::pow(std::max(0.0, (s - end + 0.005) / 0.005), 2)));
    const Vector2d outward = arch.outward(s), base = arch.point(s);
    const double top = gum + up * 0.0016 * (papilla - 0.35), bottom = sulcus - up * 0.002;
    const double middle_y = 0.5 * (top + bottom), half_y = 0.5 * std::abs(top - bottom);
    MatrixX3d ring(across_steps, 3);
    for (int i = 0; i < across_steps; ++i) {
      const double a = 2 * std::numbers::pi * i / across_steps, c = std::cos(a), sn = std::sin(a);
      const double r = std::pow(std::pow(std::abs(c), 4.0) + std::pow(std::abs(sn), 4.0), -0.25);
      const double rise = r * sn;  // -1 hidden side, 1 at the teeth
      // Labial face: just behind the crowns at the neck, level with them towards the sulcus; papillae are thinner.
      const double labial = -0.00035 - 0.0006 * std::max(0.0, rise) - 0.0005 * papilla * std::max(0.0, rise);
      const double offset = labial - thickness * 0.5 * (1 - r * c * closing);
      const double y = middle_y + up * half_y * rise * (0.6 + 0.4 * closing);
      const Vector2d plane = base + offset * outward;
      ring.row(i) << side * plane.x(), y, plane.y();
    }
    if (k == 0) ring.col(0).setZero();
    rings.push_back(ring);
  }
  return loft(rings);
}

}  // namespace

TriangleMesh make_upper_teeth(const Proportions& p) {
  return make_teeth(upper_arch(p.arch), upper_sizes, p.arch.upper_gum, p.arch.upper_edge);
}

TriangleMesh make_lower_teeth(const Proportions& p) {
  return make_teeth(lower_arch(p.arch), lower_sizes, p.arch.lower_gum, p.arch.lower_edge);
}

TriangleMesh make_upper_gums(const Proportions& p) {
  return make_gums(upper_arch(p.arch), upper_sizes, p.arch.upper_gum, p.arch.upper_sulcus);
}

TriangleMesh make_lower_gums(const Proportions& p) {
  return make_gums(lower_arch(p.arch), lower_sizes, p.arch.lower_gum, p.arch.lower_sulcus);
}

}  // namespace phiz
