// SPDX-License-Identifier: GPL-3.0-or-later
/// Levels and distances of a face from its 68 landmarks (numbers as in the usual markup: 0 to 16 jaw, 17 to 26 brows,
/// 27 to 35 nose, 36 to 47 eyes, 48 to 67 mouth), the same on both sides.
#pragma once

#include "phiz/anatomy/head_template.h"

namespace phiz {

struct FaceFrame {
  double brow = 0;            ///< height of the brows, metres; heights are y
  double eyes = 0;            ///< height of the pupils
  double stomion = 0;         ///< where the lips meet
  double menton = 0;          ///< lowest point of the chin
  Vector3d nasion, nose_tip;  ///< landmarks 27 and 30
  Vector3d inner_canthus;     ///< of the left eye: x > 0
  Vector3d outer_canthus;
  Vector3d mouth_corner;
};

/// The position of a landmark on the skin. Throws phiz::Error(bad_input) when the head does not have it.
Vector3d landmark_position(const HeadTemplate& head, const std::string& name);

/// Throws as landmark_position does.
FaceFrame face_frame(const HeadTemplate& head);

}  // namespace phiz
