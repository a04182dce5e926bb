// SPDX-License-Identifier: GPL-3.0-or-later
/// What makes one person's head differ from another's: named parameters in standard deviations.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "phiz/anatomy/builtin/proportions.h"

namespace phiz {

/// All in standard deviations from the mean, 0 = mean; plausible within [-2.5, 2.5]. What one deviation is in
/// millimetres stands in identity.cpp.
struct IdentityParameters {
  double head_length = 0;      ///< glabella to back of the head
  double head_width = 0;       ///< breadth of the vault
  double head_height = 0;      ///< crown above the eyes
  double face_width = 0;       ///< across the cheekbones
  double face_length = 0;      ///< nasion to chin
  double forehead_slope = 0;   ///< positive: forehead leans back
  double brow_ridge = 0;       ///< positive: heavier ridge
  double eye_spacing = 0;      ///< positive: further apart
  double eye_size = 0;         ///< opening between the lids
  double eye_tilt = 0;         ///< positive: outer corners higher
  double eye_depth = 0;        ///< positive: deeper set
  double nose_length = 0;      ///< nasion to tip
  double nose_width = 0;       ///< across the wings
  double nose_projection = 0;  ///< tip forward
  double nose_bridge = 0;      ///< positive: high, convex bridge
  double nose_tip = 0;         ///< positive: tip turned up
  double cheekbones = 0;       ///< positive: prominent
  double cheek_fullness = 0;   ///< positive: round cheeks
  double mouth_width = 0;      ///< corner to corner
  double upper_lip = 0;        ///< fullness of the upper vermilion
  double lower_lip = 0;        ///< fullness of the lower vermilion
  double philtrum = 0;         ///< positive: longer upper lip
  double jaw_width = 0;        ///< across the jaw angles
  double chin_height = 0;      ///< lower lip to chin's edge
  double chin_projection = 0;  ///< positive: chin forward
  double ear_size = 0;         ///< height and width of the ear
  double ear_flare = 0;        ///< positive: ears stand out
  double neck_thickness = 0;   ///< girth of the neck
  double fat = 0;              ///< flesh over the whole face and under the chin
  double lid_fold = 0;         ///< positive: the upper lid's fold hangs fuller
  double brow_height = 0;      ///< positive: brows further above the eyes
  double nose_tip_width = 0;   ///< positive: a broad, round tip
  double chin_width = 0;       ///< positive: a broad chin
};

/// A parameter with its name, so that parameters can be listed, read and written.
struct IdentityParameterName {
  std::string_view name;
  double IdentityParameters::*value;
};
inline constexpr int identity_parameter_count = 33;
extern const std::array<IdentityParameterName, identity_parameter_count> identity_parameter_names;

/// A plausible adult: normal deviates, clamped to +-2.2, that hang together as they do in people through sex, size,
/// weight and breadth of nose and lips. The same person for the same seed on every machine.
IdentityParameters random_identity(std::uint64_t seed);

/// The covariance of the parameters among people, in the order of identity_parameter_names; variances are 1.
MatrixXd identity_covariance();

/// The proportions of a person, for skin, skull and teeth alike. Parameters outside [-4, 4] or not finite are rejected
/// with phiz::Error (bad_input).
Proportions personalise(const Proportions& mean, const IdentityParameters& identity);

}  // namespace phiz
