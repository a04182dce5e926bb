// SPDX-License-Identifier: GPL-3.0-or-later
/// The ring of the lips as a row of cross-sections that the orbicularis oris moves, rolls and presses, and the surface
/// between the lips that neither may cross.
#pragma once

#include <vector>

#include "phiz/anatomy/builtin/expressions/flesh.h"
#include "phiz/anatomy/builtin/expressions/recipes.h"
#include "phiz/anatomy/head_template.h"

namespace phiz {

class LipControl {
 public:
  /// Needs the skin regions loop:upperLipLine and loop:lowerLipLine (ordered from corner to corner) and upperLip,
  /// lowerLip. Throws phiz::Error naming the region that is missing.
  explicit LipControl(const HeadTemplate& head);

  /// Handles that move the lips as the recipe says; the lower lip also goes with the jaw. `left_only` fades the
  /// motion out across the midline. None where the recipe does not hold the lips.
  std::vector<Handle> handles(const ExpressionRecipe& recipe, const Eigen::Isometry3d& jaw) const;

  /// 1 for vertices at the parting line, 0 for those 8 mm away from it; one entry per row of volume.V.
  const VectorXd& nearness() const { return nearness_; }

 private:
  /// One skin vertex near the mouth.
  struct LipVertex {
    int vertex;                       ///< row of volume.V
    double along;                     ///< -1 right corner, 0 centre, 1 left corner
    double grip;                      ///< how firmly the ring of the lips holds it: 1 near the parting line, 0 at 16 mm
    double follow;                    ///< share of the lip's way that it goes: 1 near the line, 0 at 24 mm
    double slide_grip, slide_follow;  ///< the same where a corner that is drawn far back takes the cheek's lining along
    double lip;                       ///< how far it belongs to the body of the lip, which rolls
    bool upper;
    Vector3d rest;
  };
  struct Frame {
    Vector3d middle, along, up, out;
  };
  Frame frame_at(double along) const;
  /// Takes a lip as a whole to where upper and lower lip meet on an open jaw; what is round the lips stretches.
  Handle sealed(const LipVertex& v, const Eigen::Isometry3d& jaw) const;

  VectorXd nearness_;
  std::vector<LipVertex> vertices_;
  MatrixX3d line_;  ///< the parting line from the right corner to the left, evenly spaced in `along`
};

}  // namespace phiz
