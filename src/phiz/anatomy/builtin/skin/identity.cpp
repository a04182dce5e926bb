// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/skin/identity.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "phiz/core/error.h"
#include "phiz/core/random.h"

namespace phiz {

using P = IdentityParameters;
const std::array<IdentityParameterName, identity_parameter_count> identity_parameter_names = {{
    {"head_length", &P::head_length},
    {"head_width", &P::head_width},
    {"head_height", &P::head_height},
    {"face_width", &P::face_width},
    {"face_length", &P::face_length},
    {"forehead_slope", &P::forehead_slope},
    {"brow_ridge", &P::brow_ridge},
    {"eye_spacing", &P::eye_spacing},
    {"eye_size", &P::eye_size},
    {"eye_tilt", &P::eye_tilt},
    {"eye_depth", &P::eye_depth},
    {"nose_length", &P::nose_length},
    {"nose_width", &P::nose_width},
    {"nose_projection", &P::nose_projection},
    {"nose_bridge", &P::nose_bridge},
    {"nose_tip", &P::nose_tip},
    {"cheekbones", &P::cheekbones},
    {"cheek_fullness", &P::cheek_fullness},
    {"mouth_width", &P::mouth_width},
    {"upper_lip", &P::upper_lip},
    {"lower_lip", &P::lower_lip},
    {"philtrum", &P::philtrum},
    {"jaw_width", &P::jaw_width},
    {"chin_height", &P::chin_height},
    {"chin_projection", &P::chin_projection},
    {"ear_size", &P::ear_size},
    {"ear_flare", &P::ear_flare},
    {"neck_thickness", &P::neck_thickness},
    {"fat", &P::fat},
    {"lid_fold", &P::lid_fold},
    {"brow_height", &P::brow_height},
    {"nose_tip_width", &P::nose_tip_width},
    {"chin_width", &P::chin_width},
}};

namespace {

/// How much of a parameter's deviation comes from what many parameters share; the rest is its own.
struct Shares {
  double P::*parameter;
  double male, size, weight, breadth;  // breadth of nose and lips, with a low bridge
};
constexpr Shares shares[] = {{&P::head_length, 0.55, 0.4, 0, 0},
                             {&P::head_width, 0.45, 0.4, 0, 0},
                             {&P::head_height, 0.3, 0.4, 0, 0},
                             {&P::face_width, 0.5, 0.35, 0.25, 0},
                             {&P::face_length, 0.55, 0.4, 0, 0},
                             {&P::forehead_slope, 0.45, 0, 0, 0},
                             {&P::brow_ridge, 0.75, 0, 0, 0},
                             {&P::eye_spacing, 0.2, 0.4, 0, 0.2},
                             {&P::eye_size, -0.35, 0, 0, 0},
                             {&P::eye_depth, 0.3, 0, 0, -0.2},
                             {&P::nose_length, 0.45, 0.3, 0, -0.3},
                             {&P::nose_width, 0.35, 0.15, 0, 0.7},
                             {&P::nose_projection, 0.3, 0.15, 0, -0.4},
                             {&P::nose_bridge, 0.35, 0, 0, -0.5},
                             {&P::nose_tip, -0.35, 0, 0, 0},
                             {&P::cheekbones, -0.1, 0, -0.2, 0.2},
                             {&P::cheek_fullness, -0.2, 0, 0.65, 0},
                             {&P::mouth_width, 0.4, 0.3, 0, 0.3},
                             {&P::upper_lip, -0.15, 0, 0, 0.65},
                             {&P::lower_lip, -0.15, 0, 0, 0.65},
                             {&P::philtrum, 0.45, 0, 0, 0},
                             {&P::jaw_width, 0.5, 0.2, 0.3, 0},
                             {&P::chin_height, 0.45, 0.2, 0, 0},
                             {&P::chin_projection, 0.25, 0, 0, -0.25},
                             {&P::ear_size, 0.45, 0.3, 0, 0},
                             {&P::neck_thickness, 0.7, 0.2, 0.45, 0},
                             {&P::fat, 0, 0, 0.9, 0},
                             {&P::lid_fold, 0.1, 0, 0.3, 0.1},
                             {&P::brow_height, -0.45, 0, 0, 0},
                             {&P::nose_tip_width, 0.3, 0, 0.1, 0.4},
                             {&P::chin_width, 0.5, 0.1, 0.1, 0}};

/// The shares of a parameter, and what is its own, so that its variance is 1.
struct Loading {
  double male = 0, size = 0, weight = 0, breadth = 0, own = 1;
};
Loading loading(double P::*parameter) {
  for (const Shares& of : shares)
    if (of.parameter == parameter)
      return {of.male, of.size, of.weight, of.breadth,
              std::sqrt(1 - (of.male * of.male + of.size * of.size + of.weight * of.weight + of.breadth * of.breadth))};
  return {};
}

}  // namespace

IdentityParameters random_identity(std::uint64_t seed) {
  Random random(seed, 0x5eed);
  constexpr double most = 2.2;
  IdentityParameters identity;
  const double male = (random.uniform() < 0.5 ? -0.92 : 0.92) + 0.39 * random.normal();  // variance 1
  const double size = random.normal(), weight = random.normal(), breadth = random.normal();
  for (const auto& parameter : identity_parameter_names) {
    const Loading of = loading(parameter.value);
    const double shared = of.male * male + of.size * size + of.weight * weight + of.breadth * breadth;
    identity.*parameter.value = std::clamp(shared + of.own * random.normal(), -most, most);
  }
  return identity;
}

MatrixXd identity_covariance() {
  MatrixXd loadings = MatrixXd::Zero(identity_parameter_count, 4 + identity_parameter_count);
  for (int i = 0; i < identity_parameter_count; ++i) {
    const Loading of = loading(identity_parameter_names[static_cast<std::size_t>(i)].value);
    loadings.row(i).head<4>() << of.male, of.size, of.weight, of.breadth;
    loadings(i, 4 + i) = of.own;
  }
  return loadings * loadings.transpose();
}

Proportions personalise(const Proportions& mean, const IdentityParameters& q) {
  for (const auto& parameter : identity_parameter_names) {
    const double value = q.*parameter.value;
    if (!std::isfinite(value) || std::abs(value) > 4)
      reject("identity parameter " + std::string(parameter.name),
             "it must be a number between -4 and 4 (standard deviations)");
  }
  constexpr double mm = 1e-3;
  Proportions p = mean;
  // Vault.
  p.opisthocranion.y() -= 7.5 * mm * q.head_length;
  p.euryon.x() += 3.3 * mm * q.head_width;
  p.vertex.x() += 6 * mm * q.head_height;
  p.trichion += Vector2d(3.5 * q.head_height, -3.5 * q.forehead_slope) * mm;
  p.glabella.y() += (1.4 * q.brow_ridge - 0.4 * q.forehead_slope) * mm;
  // Width of the face.
  p.zygion.x() += 3.8 * mm * q.face_width;
  p.tragion.x() += 3.2 * mm * q.face_width;
  p.condyle.x() += 2.3 * mm * q.face_width;
  p.gonion.x() += (3.8 * q.jaw_width + 2.0 * q.face_width) * mm;
  // Eyes.
  const Vector3d spacing((1.4 * q.eye_spacing + 0.7 * q.face_width) * mm, 0, -1.5 * q.eye_depth * mm);
  p.eye_centre += spacing;
  p.endocanthion += spacing + Vector3d(0, -0.4 * q.eye_tilt, 0) * mm;
  p.exocanthion += spacing + Vector3d(0, 1.1 * q.eye_tilt, 0) * mm;
  // Lower face hangs together: everything below the nose moves with the length of the face.
  const double nose_down = 3.2 * mm * q.nose_length, face_down = 4.8 * mm * q.face_length + 0.6 * nose_down;
  p.pronasale += Vector2d(-nose_down + 2.0 * mm * q.nose_tip - 0.6 * mm * q.face_length, 2.5 * mm * q.nose_projection);
  p.subnasale += Vector2d(-0.8 * nose_down - 0.2 * face_down, 0.6 * mm * q.nose_projection);
  p.alare += Vector3d(1.9 * q.nose_width * mm, -0.9 * nose_down - 0.15 * face_down, 0.3 * mm * q.nose_projection);
  const double lip_down = 0.5 * face_down + 1.4 * mm * q.philtrum, chin_down = face_down + 2.7 * mm * q.chin_height;
  p.labrale_superius.x() -= lip_down;
  p.stomion.x() -= lip_down;
  p.labrale_inferius.x() -= lip_down;
  p.sublabiale.x() -= lip_down + 0.3 * (chin_down - lip_down);
  p.cheilion += Vector3d(2.1 * q.mouth_width * mm, -lip_down, -0.5 * q.mouth_width * mm);
  p.pogonion += Vector2d(-0.75 * chin_down, 3.0 * mm * q.chin_projection);
  p.menton += Vector2d(-chin_down, 2.7 * mm * q.chin_projection);
  p.gonion.y() -= 0.5 * face_down;
  // Teeth keep with the lips.
  auto& arch = p.arch;
  for (double* y :
       {&arch.upper_gum, &arch.upper_edge, &arch.lower_edge, &arch.lower_gum, &arch.upper_sulcus, &arch.lower_sulcus})
    *y -= lip_down;
  arch.upper_sulcus += 0.3 * lip_down;
  arch.half_width += 0.5 * mm * q.face_width;
  return p;
}

}  // namespace phiz
