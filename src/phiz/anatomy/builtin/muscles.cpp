// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/muscles.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace phiz {
namespace {

constexpr int points_per_fibre = 13;

/// A row across a muscle: where its first and its last fibre pass, on the skin as seen from the front.
using Row = std::pair<Vector3d, Vector3d>;

/// The face as a mask z(x, y): the midline profile without the nose, bent back towards the sides.
class Mask {
 public:
  explicit Mask(const Proportions& p) {
    const Vector2d under_nose(0.5 * (p.nasion.x() + p.subnasale.x()), p.subnasale.y() - 0.012);
    profile_ = {p.menton,   p.pogonion, p.sublabiale, p.stomion,  p.subnasale,
                under_nose, p.nasion,   p.glabella,   p.trichion, p.vertex};
    width_ = {{p.menton.x() - 0.03, 0.052},        {p.menton.x(), 0.8 * p.gonion.x()},
              {p.gonion.y(), 1.12 * p.gonion.x()}, {p.zygion.y(), 1.11 * p.zygion.x()},
              {p.euryon.y(), p.euryon.x()},        {p.vertex.x(), 0.5 * p.euryon.x()}};
  }

  Vector3d operator()(double x, double y) const {
    const double share = std::min(0.98, std::abs(x) / interpolate(width_, y));
    return {x, y, interpolate(profile_, y) * std::pow(1 - std::pow(share, 2.2), 1 / 2.2)};
  }

 private:
  static double interpolate(const std::vector<Vector2d>& curve, double at) {
    const auto above = std::find_if(curve.begin(), curve.end(), [at](const Vector2d& c) { return c.x() > at; });
    if (above == curve.begin()) return curve.front().y();
    if (above == curve.end()) return curve.back().y();
    const Vector2d &a = above[-1], &b = above[0];
    return a.y() + (b.y() - a.y()) * (at - a.x()) / (b.x() - a.x());
  }

  std::vector<Vector2d> profile_, width_;
};

/// `count` fibres through the rows, from origin to insertion.
MuscleBundle sheet(std::string name, const std::vector<Row>& rows, int count, double radius, double origin_depth,
                   double insertion_depth) {
  MuscleBundle bundle{std::move(name), {}, radius, origin_depth, insertion_depth};
  const auto last = static_cast<double>(rows.size() - 1);
  for (int f = 0; f < count; ++f) {
    const double across = count == 1 ? 0.5 : f / double(count - 1);
    MatrixX3d fibre(points_per_fibre, 3);
    for (int i = 0; i < points_per_fibre; ++i) {
      const double along = last * i / (points_per_fibre - 1);
      const auto below = std::min(static_cast<std::size_t>(along), rows.size() - 2);
      const double t = along - static_cast<double>(below);
      const Row &a = rows[below], &b = rows[below + 1];
      const Vector3d first = (1 - t) * a.first + t * b.first, second = (1 - t) * a.second + t * b.second;
      fibre.row(i) = ((1 - across) * first + across * second).transpose();
    }
    bundle.fibres.push_back(fibre);
  }
  return bundle;
}

/// Closed elliptic fibres round `centre`, from the inner to the outer half axes (x towards the side, y up, y down).
MuscleBundle ring(std::string name, const Mask& mask, const Vector2d& centre, const Vector3d& inner,
                  const Vector3d& outer, int count, double radius, double depth) {
  MuscleBundle bundle{std::move(name), {}, radius, depth, depth};
  constexpr int steps = 36;
  for (int f = 0; f < count; ++f) {
    const Vector3d axes = inner + (outer - inner) * (count == 1 ? 0.0 : f / double(count - 1));
    MatrixX3d fibre(steps + 1, 3);
    for (int i = 0; i <= steps; ++i) {
      const double angle = std::numbers::pi + 2 * std::numbers::pi * (i % steps) / steps;  // from the medial side
      const double y = std::sin(angle) * (std::sin(angle) > 0 ? axes.y() : axes.z());
      fibre.row(i) = mask(centre.x() + axes.x() * std::cos(angle), centre.y() + y).transpose();
    }
    bundle.fibres.push_back(fibre);
  }
  return bundle;
}

MuscleBundle mirrored(const MuscleBundle& left, const std::string& name) {
  MuscleBundle right = left;
  right.name = name;
  for (MatrixX3d& fibre : right.fibres) fibre.col(0) *= -1;
  return right;
}

/// The left muscles, their names without "Left".
std::vector<MuscleBundle> left_muscles(const Proportions& p, const Mask& mask) {
  const Vector3d eye = p.eye_centre, ala = p.alare, corner = p.cheilion, zyg = p.zygion, jaw = p.gonion;
  const double lip_top = p.labrale_superius.x(), lip_bottom = p.labrale_inferius.x(), brow = p.glabella.x();
  const auto at = [&mask](double x, double y) { return mask(x, y); };
  const double mm = 1e-3;
  std::vector<MuscleBundle> all;
  all.push_back(sheet("frontalis",
                      {{at(6 * mm, p.trichion.x()), at(50 * mm, p.trichion.x() - 14 * mm)},
                       {at(5 * mm, brow + 22 * mm), at(49 * mm, brow + 14 * mm)},
                       {at(6 * mm, brow + 1 * mm), at(50 * mm, brow)}},
                      9, 0.0032, 0.55, 0.75));
  all.push_back(sheet("corrugator",
                      {{at(4 * mm, brow - 3 * mm), at(6 * mm, brow - 8 * mm)},
                       {at(17 * mm, brow + 2 * mm), at(18 * mm, brow - 4 * mm)},
                       {at(30 * mm, brow + 5 * mm), at(31 * mm, brow)}},
                      3, 0.0022, 0.1, 0.75));
  all.push_back(ring("orbicularisOculi", mask, eye.head<2>(), {18 * mm, 8 * mm, 9 * mm}, {28 * mm, 21 * mm, 22 * mm}, 5,
                     0.002, 0.7));
  all.push_back(sheet("nasalis",
                      {{at(ala.x() + 3 * mm, ala.y() - 9 * mm), at(ala.x() + 6 * mm, ala.y() - 4 * mm)},
                       {at(ala.x() - 1 * mm, ala.y() + 5 * mm), at(ala.x() + 1 * mm, ala.y() + 9 * mm)},
                       {at(3 * mm, ala.y() + 19 * mm), at(3 * mm, ala.y() + 24 * mm)}},
                      3, 0.0016, 0.1, 0.6));
  all.push_back(sheet("levatorLabiiSuperiorisAlaequeNasi",
                      {{at(9 * mm, eye.y() + 3 * mm), at(12 * mm, eye.y() + 1 * mm)},
                       {at(14 * mm, ala.y() + 12 * mm), at(17 * mm, ala.y() + 12 * mm)},
                       {at(ala.x() - 2 * mm, ala.y() - 2 * mm), at(ala.x() + 1 * mm, lip_top + 9 * mm)}},
                      2, 0.002, 0.15, 0.8));
  all.push_back(sheet("levatorLabiiSuperioris",
                      {{at(eye.x() - 9 * mm, eye.y() - 17 * mm), at(eye.x() + 5 * mm, eye.y() - 18 * mm)},
                       {at(ala.x() + 3 * mm, ala.y() - 6 * mm), at(ala.x() + 10 * mm, ala.y() - 7 * mm)},
                       {at(11 * mm, lip_top + 3 * mm), at(19 * mm, lip_top + 2 * mm)}},
                      3, 0.0022, 0.15, 0.75));
  all.push_back(sheet("zygomaticusMinor",
                      {{at(0.72 * zyg.x(), zyg.y() - 3 * mm), at(0.75 * zyg.x(), zyg.y() - 3 * mm)},
                       {at(34 * mm, ala.y() - 8 * mm), at(36 * mm, ala.y() - 10 * mm)},
                       {at(19 * mm, lip_top + 3 * mm), at(22 * mm, lip_top + 1 * mm)}},
                      2, 0.0024, 0.15, 0.75));
  all.push_back(sheet("zygomaticusMajor",
                      {{at(0.82 * zyg.x(), zyg.y() - 7 * mm), at(0.86 * zyg.x(), zyg.y() - 6 * mm)},
                       {at(43 * mm, ala.y() - 16 * mm), at(45 * mm, ala.y() - 18 * mm)},
                       {at(corner.x() + 1 * mm, corner.y() + 3 * mm), at(corner.x() + 1 * mm, corner.y())}},
                      3, 0.003, 0.15, 0.7));
  all.push_back(sheet("levatorAnguliOris",
                      {{at(eye.x() - 6 * mm, ala.y() + 1 * mm), at(eye.x() + 3 * mm, ala.y() + 1 * mm)},
                       {at(corner.x() - 1 * mm, corner.y() + 3 * mm), at(corner.x() + 3 * mm, corner.y() + 2 * mm)}},
                      2, 0.0022, 0.1, 0.6));
  all.push_back(sheet("risorius",
                      {{at(0.9 * jaw.x(), corner.y() + 2 * mm), at(0.9 * jaw.x(), corner.y() - 8 * mm)},
                       {at(corner.x() + 2 * mm, corner.y()), at(corner.x() + 2 * mm, corner.y() - 3 * mm)}},
                      3, 0.0018, 0.6, 0.75));
  all.push_back(sheet("buccinator",
                      {{mask(0.8 * jaw.x(), corner.y() + 10 * mm) - Vector3d(0, 0, 14 * mm),
                        mask(0.8 * jaw.x(), corner.y() - 10 * mm) - Vector3d(0, 0, 14 * mm)},
                       {at(corner.x() + 8 * mm, corner.y() + 6 * mm), at(corner.x() + 8 * mm, corner.y() - 6 * mm)},
                       {at(corner.x() + 1 * mm, corner.y() + 2 * mm), at(corner.x() + 1 * mm, corner.y() - 2 * mm)}},
                      5, 0.0024, 0.3, 0.5));
  all.push_back(sheet("depressorAnguliOris",
                      {{at(corner.x() + 1 * mm, p.pogonion.x() - 5 * mm), at(corner.x() + 13 * mm, p.pogonion.x())},
                       {at(corner.x() + 2 * mm, corner.y() - 14 * mm), at(corner.x() + 9 * mm, corner.y() - 14 * mm)},
                       {at(corner.x(), corner.y() - 2 * mm), at(corner.x() + 2 * mm, corner.y() - 1 * mm)}},
                      4, 0.0022, 0.2, 0.75));
  all.push_back(sheet("depressorLabiiInferioris",
                      {{at(17 * mm, p.pogonion.x()), at(28 * mm, p.pogonion.x() + 2 * mm)},
                       {at(7 * mm, lip_bottom - 3 * mm), at(17 * mm, lip_bottom - 1 * mm)}},
                      4, 0.0022, 0.15, 0.75));
  all.push_back(sheet("mentalis",
                      {{at(4 * mm, p.sublabiale.x() + 1 * mm), at(9 * mm, p.sublabiale.x() + 1 * mm)},
                       {at(4 * mm, p.pogonion.x() - 3 * mm), at(10 * mm, p.pogonion.x() - 2 * mm)}},
                      3, 0.0028, 0.1, 0.85));
  all.push_back(sheet("platysma",
                      {{at(10 * mm, p.menton.x() - 60 * mm), at(50 * mm, p.menton.x() - 60 * mm)},
                       {at(12 * mm, p.menton.x() - 20 * mm), at(50 * mm, jaw.y() - 32 * mm)},
                       {at(16 * mm, p.menton.x() + 3 * mm), at(0.95 * jaw.x(), jaw.y() - 8 * mm)},
                       {at(19 * mm, p.pogonion.x() + 5 * mm), at(corner.x() + 16 * mm, corner.y() - 8 * mm)}},
                      8, 0.0018, 0.75, 0.75));
  all.push_back(sheet("masseter",
                      {{Vector3d(0.88 * zyg.x(), zyg.y() - 4 * mm, zyg.z() + 10 * mm),
                        Vector3d(0.95 * zyg.x(), zyg.y() - 4 * mm, zyg.z() - 12 * mm)},
                       {Vector3d(jaw.x(), jaw.y() + 3 * mm, jaw.z() + 19 * mm),
                        Vector3d(jaw.x() + 2 * mm, jaw.y() + 6 * mm, jaw.z() + 3 * mm)}},
                      5, 0.004, 0.2, 0.25));
  all.push_back(sheet("temporalis",
                      {{Vector3d(0.78 * zyg.x(), eye.y() + 22 * mm, zyg.z() + 5 * mm),
                        Vector3d(zyg.x(), eye.y() + 20 * mm, zyg.z() - 55 * mm)},
                       {Vector3d(0.85 * zyg.x(), zyg.y() + 2 * mm, zyg.z() - 4 * mm),
                        Vector3d(0.9 * zyg.x(), zyg.y() + 2 * mm, zyg.z() - 14 * mm)}},
                      7, 0.0028, 0.35, 0.3));
  return all;
}

}  // namespace

FibrePoint nearest_on_fibre(const MatrixX3d& fibre, const Vector3d& p) {
  FibrePoint best{0, 0, 1e30};
  for (Eigen::Index i = 0; i + 1 < fibre.rows(); ++i) {
    const Vector3d a = fibre.row(i), e = fibre.row(i + 1).transpose() - a;
    const double t = std::clamp((p - a).dot(e) / std::max(e.squaredNorm(), 1e-18), 0.0, 1.0);
    const double d = (a + t * e - p).squaredNorm();
    if (d < best.squared_distance) best = {i, t, d};
  }
  return best;
}

std::vector<MuscleBundle> make_muscle_bundles(const Proportions& p) {
  const Mask mask(p);
  const double mm = 1e-3;
  std::vector<MuscleBundle> all;
  std::vector<MuscleBundle> closers;
  for (MuscleBundle& left : left_muscles(p, mask)) {
    const std::string stem = left.name;
    left.name = stem + "Left";
    auto& list = stem == "masseter" || stem == "temporalis" ? closers : all;
    list.push_back(left);
    list.push_back(mirrored(left, stem + "Right"));
  }
  all.push_back(sheet("procerus",
                      {{mask(-3 * mm, p.nasion.x() - 10 * mm), mask(3 * mm, p.nasion.x() - 10 * mm)},
                       {mask(-7 * mm, p.glabella.x() + 8 * mm), mask(7 * mm, p.glabella.x() + 8 * mm)}},
                      5, 0.0018, 0.2, 0.75));
  const double half = p.cheilion.x(), above = p.labrale_superius.x() - p.stomion.x(),
               below = p.stomion.x() - p.labrale_inferius.x();
  all.push_back(ring("orbicularisOris", mask, {0, p.stomion.x()}, {0.93 * half, 0.75 * above, 0.8 * below},
                     {1.22 * half, above + 7 * mm, below + 6 * mm}, 4, 0.0024, 0.65));
  // Between the maxilla above the incisors and the septum, where the nostrils are nearer than the bone.
  const Vector2d base = p.subnasale;
  all.push_back(sheet("depressorSepti",
                      {{Vector3d(-4 * mm, base.x() - 9 * mm, base.y() - 10 * mm),
                        Vector3d(4 * mm, base.x() - 9 * mm, base.y() - 10 * mm)},
                       {Vector3d(-2.5 * mm, base.x() + 1 * mm, base.y() - 2 * mm),
                        Vector3d(2.5 * mm, base.x() + 1 * mm, base.y() - 2 * mm)}},
                      3, 0.0016, 0.15, 0.7));
  all.back().placed = true;
  all.insert(all.end(), closers.begin(), closers.end());
  return all;
}

}  // namespace phiz
