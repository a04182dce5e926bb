// SPDX-License-Identifier: GPL-3.0-or-later
/// The gates that a head must pass before people animate it, and the figures behind them. `validate` refuses what is
/// malformed; this measures what is well-formed but may be poor.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "phiz/anatomy/head_measures.h"
#include "phiz/anatomy/head_template.h"

namespace phiz {

/// One thing that is measured against a bound.
struct Gate {
  std::string name;
  double measured = 0;
  double bound = 0;
  bool at_least = false;  ///< the measured value must be at least the bound; else at most
  std::string unit;       ///< "mm", "degrees", "" for counts
  std::string note;       ///< what is worst, or missing
  bool holds() const { return at_least ? measured >= bound : measured <= bound; }
};

/// "ok    smallest dihedral angle   6.1 degrees (at least 5)".
std::string readable(const Gate& gate);

/// Everything that was measured.
struct HeadReport {
  std::vector<Gate> gates;
  std::vector<MeasuredThickness> thickness;
  std::vector<MuscleFigures> muscles;
  Occlusion occlusion;
  std::vector<ExpressionFigures> expressions;     ///< not a gate
  std::size_t drawn_skin_self_intersections = 0;  ///< pairs of triangles; not a gate
  double active_share = 0;                        ///< of all flesh
  double active_share_of_face = 0;                ///< of the flesh of the face, see head_measures.h

  bool passes() const;
};

/// Measures the head against these gates:
///
/// | gate                              | bound                                                                      |
/// |-----------------------------------|----------------------------------------------------------------------------|
/// | inverted tets                     | none                                                                       |
/// | smallest dihedral angle           | at least 5 degrees, at every size: flat tets are not a matter of size      |
/// | simulated bones inside the skin   | at least 1 mm, against the whole simulation skin                           |
/// | drawn bones inside the skin       | at least 1 mm, against the drawn skin as seen from outside; not the teeth  |
/// | flesh thickness                   | mean absolute difference from thickness_table at most 2.5 mm               |
/// | thickness landmarks               | at least 16 of the table's (Ichim et al. 2017, section 5.3.1)              |
/// | muscles inside the flesh          | at least 0.95 of the volume of each                                        |
/// | fibre directions                  | median per muscle within 25 degrees of its own axis                        |
/// | self-intersections of the skin    | none in the simulation skin at rest                                        |
/// | teeth in each other               | at most 0.3 mm                                                             |
/// | expressions, landmarks, muscles   | 52, 68, and the 33 of expression present                                   |
/// | pins, slides                      | at least one of each                                                       |
///
/// `report`, when given, is called with the name of each step before it begins.
HeadReport check_head(const HeadTemplate& head, const std::function<void(const std::string&)>& report = {});

}  // namespace phiz
