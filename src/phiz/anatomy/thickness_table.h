// SPDX-License-Identifier: GPL-3.0-or-later
/// Usual flesh thickness at craniometric landmarks (Ichim et al. 2017, section 5.3.1). Pooled adults, after the summary
/// tables of Stephan and Simpson (2008, doi 10.1111/j.1556-4029.2008.00852.x), rounded to half a millimetre; priors,
/// with a deviation of 30 %, at least 1.5 mm.
#pragma once

#include <span>
#include <string_view>

namespace phiz {

struct UsualThickness {
  std::string_view name;  ///< of the landmark; paired ones are named with Left or Right behind in a head
  double mean = 0;        ///< metres, from the bone to the skin
  double deviation = 0;   ///< metres
  bool paired = false;
  bool on_mandible = false;
  bool published = true;  ///< false: not in the source, a value between those of its neighbours
};

/// All landmarks, midline ones first.
std::span<const UsualThickness> thickness_table();

/// The entry of a landmark of a head, e.g. "gonionLeft", or nullptr.
const UsualThickness* find_usual_thickness(std::string_view landmark);

}  // namespace phiz
