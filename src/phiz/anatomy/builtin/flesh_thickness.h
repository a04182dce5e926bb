// SPDX-License-Identifier: GPL-3.0-or-later
/// Where the landmarks of the thickness table lie on the built-in head.
#pragma once

#include <string>
#include <vector>

#include "phiz/anatomy/builtin/proportions.h"
#include "phiz/anatomy/head_template.h"

namespace phiz {

/// A place on the skin and the usual thickness of the flesh under it, metres.
struct ThicknessSite {
  std::string name;
  Vector3d skin;         ///< on the skin, or close to it
  double thickness = 0;  ///< towards the bone, of the table
  double deviation = 0;
  bool on_mandible = false;
};

/// Sites of a person: midline ones, then left and right pairs (names end in Left or Right). At least 16.
std::vector<ThicknessSite> thickness_sites(const Proportions& proportions);

/// Thickness anywhere near the skin, interpolated between the sites (inverse fourth power of the distance).
class ThicknessField {
 public:
  explicit ThicknessField(const Proportions& proportions) : sites_(thickness_sites(proportions)) {}
  double operator()(const Vector3d& p) const;

 private:
  std::vector<ThicknessSite> sites_;
};

/// The skull landmarks of `head`, which has its volume, carriers and skin: for each site the bone vertex below it from
/// which one comes out of the skin near the site, the mean of its normal and the skin's, the thickness along it up to
/// the skin, as this head has it, and a deviation of 30 % (at least 1.5 mm). Sites without bone in their place, or with
/// flesh more than three deviations thicker than usual, are left out.
std::vector<SkullLandmark> find_skull_landmarks(const HeadTemplate& head, const Proportions& proportions);

}  // namespace phiz
