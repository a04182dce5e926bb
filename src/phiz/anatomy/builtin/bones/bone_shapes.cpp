// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/bones/bone_shapes.h"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "phiz/anatomy/bones/implicit.h"

namespace phiz {
namespace {

using implicit::BarNode;
using implicit::blend;
using implicit::capsule;
using implicit::carve;
using implicit::ellipsoid;
using implicit::rounded_box;

// Shapes are written in millimetres of the left half; the functions below receive (|x|, y, z) in millimetres.

double cranial_vault(const Vector3d& p) {
  const double parietal = ellipsoid(p, {0, 58, -24}, {70.5, 77, 83});
  const double frontal = ellipsoid(p, {0, 66, 7}, {55, 57, 56});
  const double eminence = ellipsoid(p, {24, 68, 34}, {26, 30, 24});
  const double occipital = ellipsoid(p, {0, 22, -58}, {50, 38, 49});
  const double base = ellipsoid(p, {0, 10, -38}, {50, 26, 48});
  const double bun = ellipsoid(p, {0, 28, -96}, {20, 12, 12});
  double f = blend(parietal, frontal, 18);
  f = blend(f, eminence, 14);
  f = blend(f, occipital, 14);
  f = blend(f, base, 12);
  return blend(f, bun, 12);
}

double temporal_bone(const Vector3d& p) {
  const double petrous = ellipsoid(p, {43, 10, -20}, {16, 14, 23});
  const double mastoid = capsule(p, {51, 2, -24}, {49, -19, -21}, 10, 5.5);
  return blend(petrous, mastoid, 6);
}

using Bar = std::span<const BarNode>;

constexpr int rim_nodes = 9;
const std::array<BarNode, rim_nodes> orbital_rim{{{{13, 33, 60}, 5},
                                                  {{17, 42.5, 62}, 5.5},
                                                  {{30, 46.5, 60}, 5},
                                                  {{42, 43.5, 53.5}, 4.8},
                                                  {{49.5, 33, 44.5}, 4.5},
                                                  {{50, 20, 43}, 5},
                                                  {{44.5, 9, 49.5}, 5},
                                                  {{31, 6, 56}, 4.5},
                                                  {{18, 13, 58}, 4.2}}};
const std::array<BarNode, 5> zygomatic_arch{
    {{{51.5, 6, 39.5}, 5}, {{56.8, 7.5, 29}, 4.4}, {{58.2, 7.5, 15}, 4}, {{57.5, 7, 0}, 4.2}, {{53, 7, -12}, 6}}};
const Vector3d arch_section(1.5, 1, 1);
const std::array<BarNode, 7> mandible_body{{{{44, -43, 8}, 4.6},
                                            {{40.8, -49.5, 18}, 5.4},
                                            {{36.8, -54.5, 31}, 5.8},
                                            {{31, -58.4, 44}, 6},
                                            {{20, -63, 59}, 5.8},
                                            {{8, -64.5, 65.5}, 5.6},
                                            {{0, -65, 66.4}, 5.6}}};
const Vector3d body_section(1, 0.56, 1);

double brow_and_orbital_rim(const Vector3d& p) {
  const double ring = implicit::bar(p, orbital_rim, {1, 1, 1});
  const double glabella = ellipsoid(p, {0, 46, 58}, {19, 11, 10});
  const double superciliary = capsule(p, {9, 45, 63}, {27, 52, 58}, 4.5, 3);
  return blend(blend(ring, glabella, 8), superciliary, 7);
}

double zygoma(const Vector3d& p) {
  const double body = ellipsoid(p, {45, 4, 45}, {12, 12, 9});
  const double buttress = capsule(p, {42, -2, 45}, {31, -19, 41}, 8, 7);
  return blend(blend(body, buttress, 8), implicit::bar(p, zygomatic_arch, arch_section), 6);
}

double midface(const Vector3d& p) {
  const double core = rounded_box(p, {0, 4, 36}, {25, 31, 24}, 13);
  const double sphenoid = rounded_box(p, {0, 12, 8}, {28, 26, 26}, 12);
  const double infraorbital = ellipsoid(p, {26, 2, 50}, {15, 15, 12});
  const double nasal = capsule(p, {0, 37, 58}, {0, 21, 68}, 9, 7.5);
  const double frontal_process = capsule(p, {9.5, 32, 58}, {14, 4, 61}, 4.5, 4.5);
  const double spine = capsule(p, {0, -9.5, 64}, {0, -7.5, 75.5}, 4, 1.2);
  const double pterygoid = capsule(p, {16, -2, 15}, {17, -24, 15}, 6, 3.5);
  double f = blend(core, sphenoid, 12);
  f = blend(f, infraorbital, 10);
  f = blend(f, nasal, 8);
  f = blend(f, frontal_process, 6);
  f = blend(f, spine, 5);
  return blend(f, pterygoid, 6);
}

/// Distance-like offset from an elliptic arch in the xz plane, straight behind z0; negative inside.
double arch_offset(const Vector3d& p, double half_width, double depth, double z0) {
  const double x = p.x() / half_width, z = std::max(p.z() - z0, 0.0) / depth;
  const double r = std::hypot(x, z);
  const double slope = std::hypot(x / half_width, z / depth);
  return slope > 1e-9 ? r * (r - 1) / slope : -half_width;
}

double maxilla(const Vector3d& p) {
  const double outside = arch_offset(p, 28.0, 41.5, 30);
  const double slab = std::abs(p.y() + 16) - 12.5;
  const double back = 17 - p.z();
  double f = implicit::intersect(implicit::intersect(outside, slab, 5), back, 6);
  // Canine eminences and the hollows beside them.
  f = blend(f, capsule(p, {19, -8, 60}, {19.5, -26, 59.5}, 3, 3.6), 6);
  return f;
}

double palate(const Vector3d& p) {
  const double inside = arch_offset(p, 17.5, 31, 30);
  const double dome = ellipsoid(p, {0, -34, 34}, {22, 19, 36});
  return implicit::intersect(inside, dome, 5);
}

double orbit(const Vector3d& p) {
  const double bulb = ellipsoid(p, {31.5, 26.5, 50}, {17.4, 16.4, 20});
  const double opening = ellipsoid(p, {34, 26.5, 58}, {17.5, 15.5, 16});
  const double cone = capsule(p, {31, 26.5, 48}, {15, 28, 12}, 15.5, 3.5);
  return blend(blend(bulb, cone, 8), opening, 5);
}

/// Piriform aperture; without its narrow upper part, which leaves very thin bone, unless `detailed`.
double nasal_opening(const Vector3d& p, bool detailed) {
  const double lower = ellipsoid(p, {4.5, -0.5, 68}, {7.5, 7.5, 20});
  if (!detailed) return lower;
  const double upper = ellipsoid(p, {0, 5, 70}, {6.3, 11, 18});
  return blend(lower, upper, 6);
}

double temporal_fossa(const Vector3d& p) {
  const double upper = ellipsoid(p, {70, 31, 20}, {19, 36, 24});
  const double lower = ellipsoid(p, {51, -2, 14}, {13.5, 27, 23});
  return blend(upper, lower, 10);
}

/// Cervical column: a shaft; when `detailed`, bodies, transverse and spinous processes of its vertebrae.
double cervical_column(const Vector3d& p, bool detailed) {
  constexpr double top = -14, pitch = 19, bottom = -146;
  const double s = std::clamp((top - p.y()) / (top - bottom), 0.0, 1.0);
  const double z = -24 + 10 * s - 22 * s * s;  // lordosis
  const double ends = std::max(p.y() - top - 6, bottom - p.y());
  if (!detailed) return implicit::intersect(std::hypot(p.x() / 1.2, p.z() - z + 3) - 11, ends, 8);
  const double level = std::round(std::clamp((top - p.y()) / pitch, 0.0, 7.0));
  const double wave = 0.5 + 0.5 * std::cos(2 * std::numbers::pi * (top - p.y()) / pitch);
  const double shaft = std::hypot(p.x() / 1.15, p.z() - z) - (7.6 + 1.6 * wave);
  const Vector3d centre(0, top - pitch * level, z);
  const double transverse = capsule(p, centre + Vector3d(6, 0, -4), centre + Vector3d(20, -2, -6), 4.2, 3);
  const double spinous = capsule(p, centre + Vector3d(0, -1, -6), centre + Vector3d(0, -6, -23), 4, 3);
  return implicit::intersect(blend(blend(shaft, transverse, 5), spinous, 5), ends, 6);
}

double mandible_mm(const Vector3d& p) {
  double f = implicit::bar(p, mandible_body, body_section);
  const double chin = ellipsoid(p, {0, -69, 67}, {11, 6, 5.5});
  const double tubercle = ellipsoid(p, {12, -71.5, 64}, {6, 4, 4.5});
  f = blend(f, blend(chin, tubercle, 5), 6);
  // Ramus: a plate, thin in x.
  const double c = std::cos(0.12), s = std::sin(0.12);
  const double y = p.y() + 26, z = p.z() - 9.5;
  const Vector3d q(p.x() - (47.3 + 0.05 * (p.y() + 26) - 0.16 * p.z()), c * y + s * z, -s * y + c * z);
  double ramus = rounded_box(q, Vector3d::Zero(), {3.5, 26, 14.5}, 3.4);
  const double notch = capsule(p, {30, 1, 9.5}, {70, 1, 9.5}, 8.5, 8.5);
  ramus = carve(ramus, notch, 4);
  const double corner =
      -(p - Vector3d(p.x(), -38, 14)).dot(Vector3d(0, 0.73, 0.68)) - 16;  // the angle is cut obliquely
  ramus = implicit::intersect(ramus, corner, 5);
  const double coronoid = implicit::bar(
      p, std::array<BarNode, 3>{{{{47, -22, 17}, 6}, {{47, -8, 18.5}, 4.5}, {{46.5, 2, 18}, 2}}}, {1.6, 1, 1});
  const double neck = capsule(p, {50, -1, 0}, {48, -18, 0.5}, 4, 4.6);
  const double head = ellipsoid(p, {50, 0, 0}, {8.6, 4.3, 4.6});
  const double angle = ellipsoid(p, {45.3, -44, 6}, {3.6, 9, 9});
  f = blend(f, ramus, 6);
  f = blend(f, blend(coronoid, blend(neck, head, 3), 4), 5);
  return blend(f, angle, 6);
}

double skull_mm(const Vector3d& p, bool detailed) {
  double f = blend(cranial_vault(p), temporal_bone(p), 6);
  f = blend(f, midface(p), 8);
  f = blend(f, maxilla(p), 7);
  f = carve(f, temporal_fossa(p), 10);
  f = blend(f, brow_and_orbital_rim(p), 8);
  f = blend(f, zygoma(p), 6);
  f = carve(f, orbit(p) + (detailed ? 0 : 2), 4);  // sturdier rims to simulate with
  f = carve(f, nasal_opening(p, detailed), 3);
  f = carve(f, palate(p), 3);
  f = blend(f, cervical_column(p, detailed), 6);
  return carve(f, mandible_mm(p) - 1.8, 1.5);
}

Vector3d left_mm(const Vector3d& p) {
  return 1e3 * Vector3d(std::abs(p.x()), p.y(), p.z());
}

/// Corresponding points of any two people: the midline ones, then the paired ones with their mirror images.
std::vector<Vector3d> warp_landmarks(const Proportions& q) {
  std::vector<Vector3d> points;
  for (const Vector2d& m : {q.vertex, q.opisthocranion, q.trichion, q.glabella, q.nasion, q.subnasale, q.stomion,
                            q.sublabiale, q.pogonion, q.menton})
    points.emplace_back(0, m.x(), m.y());
  for (const Vector3d& left :
       {q.eye_centre, q.endocanthion, q.exocanthion, q.alare, q.zygion, q.gonion, q.tragion, q.euryon, q.condyle}) {
    points.push_back(left);
    points.emplace_back(-left.x(), left.y(), left.z());
  }
  const Proportions::DentalArch& a = q.arch;
  points.emplace_back(0, a.upper_gum, a.z0 + a.depth);
  points.emplace_back(a.half_width, a.upper_gum, a.z0);
  points.emplace_back(-a.half_width, a.upper_gum, a.z0);
  points.emplace_back(0, a.lower_gum, a.z0 + a.depth);
  points.emplace_back(a.half_width, a.lower_gum, a.z0);
  points.emplace_back(-a.half_width, a.lower_gum, a.z0);
  // The neck hangs from the head: fixed offsets below the midpoint of the gonia.
  const double depth = 0.5 * (q.gonion.z() + q.opisthocranion.y());
  for (const double y : {-0.11, -0.17}) points.emplace_back(0, q.gonion.y() + y + 0.052, depth + 0.0255);
  return points;
}

double arch_process(const Proportions& person, const Vector3d& p, double inset, double thickness, double low,
                    double high, double rise) {
  const Proportions::DentalArch& a = person.arch;
  const double outer = arch_offset(p, a.half_width - inset, a.depth - inset, a.z0);
  const double ribbon = std::abs(outer + 0.5 * thickness) - 0.5 * thickness;
  const double slab = std::max(p.y() - high, low + rise * (a.z0 + a.depth - p.z()) - p.y());
  const double back = a.z0 - 0.008 - p.z();
  return implicit::intersect(implicit::intersect(ribbon, slab, 0.003), back, 0.003);
}

}  // namespace

Proportions reference_proportions() {
  return {};
}

ReferenceWarp::ReferenceWarp(const Proportions& person) {
  const std::vector<Vector3d> from = warp_landmarks(person), to = warp_landmarks(reference_proportions());
  const auto n = static_cast<Eigen::Index>(from.size());
  MatrixXd system = MatrixXd::Zero(n + 4, n + 4);
  MatrixX3d target = MatrixX3d::Zero(n + 4, 3);
  centres_.resize(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    centres_.row(i) = from[i];
    target.row(i) = to[i] - from[i];
    for (Eigen::Index j = 0; j < n; ++j) system(i, j) = (from[i] - from[j]).norm();
    system(i, i) = -1e-3;  // a little smoothing
    system.row(i).tail(4) << 1, from[i].transpose();
    system.col(i).tail(4) = system.row(i).tail(4).transpose();
  }
  weights_ = system.fullPivLu().solve(target);
}

Vector3d ReferenceWarp::operator()(const Vector3d& p) const {
  const Eigen::Index n = centres_.rows();
  Vector3d moved = p + weights_.row(n).transpose() + weights_.bottomRows(3).transpose() * p;
  for (Eigen::Index i = 0; i < n; ++i) moved += (p - centres_.row(i).transpose()).norm() * weights_.row(i).transpose();
  return moved;
}

double reference_skull(const Vector3d& p, bool detailed) {
  return 1e-3 * skull_mm(left_mm(p), detailed);
}

double reference_skull_struts(const Vector3d& p) {
  const Vector3d q = left_mm(p);
  const double rim = implicit::bar(q, orbital_rim, {1, 1, 1}) + 1.2;
  const double arch = implicit::bar(q, zygomatic_arch, arch_section) + 0.3;
  const double nose = capsule(q, {0, 37, 58}, {0, 22, 67.5}, 6.5, 4.8);
  return 1e-3 * carve(std::min({rim, arch, nose}), orbit(q) + 1, 1);
}

double reference_mandible_struts(const Vector3d& p) {
  const Vector3d q = left_mm(p);
  return 1e-3 * (mandible_mm(q) + 0.8 + 0.09 * std::max(0.0, -15 - q.y()));
}

double reference_mandible(const Vector3d& p) {
  return 1e-3 * mandible_mm(left_mm(p));
}

double upper_alveolar_process(const Proportions& person, const Vector3d& p) {
  const Proportions::DentalArch& a = person.arch;
  return arch_process(person, p, 0.0022, 0.0065, a.upper_gum - 0.001, a.upper_sulcus + 0.006, 0);
}

double lower_alveolar_process(const Proportions& person, const Vector3d& p) {
  const Proportions::DentalArch& a = person.arch;
  return arch_process(person, p, 0.0022 + a.lower_inset, 0.0062, a.lower_sulcus - 0.006, a.lower_gum + 0.001, 0.28);
}

}  // namespace phiz
