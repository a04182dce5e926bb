// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/check_head.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "phiz/anatomy/expression_names.h"
#include "phiz/anatomy/muscle_table.h"
#include "phiz/geometry/operators.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/tetrahedralise.h"

namespace phiz {
namespace {

constexpr double mm = 1e3;

/// Counts which of the wanted names are there and notes those that are not.
template <class Wanted>
Gate presence(const std::string& name, const Wanted& wanted, const std::set<std::string>& present) {
  Gate gate{name, 0, static_cast<double>(wanted.size()), true, "", ""};
  for (const auto& item : wanted) {
    if (present.contains(std::string(item)))
      ++gate.measured;
    else
      gate.note += (gate.note.empty() ? "missing: " : ", ") + std::string(item);
  }
  return gate;
}

template <class Things>
std::set<std::string> names_of(const Things& things) {
  std::set<std::string> names;
  for (const auto& thing : things) names.insert(thing.name);
  return names;
}

Gate count(const std::string& name, std::size_t found, double most) {
  return {name, static_cast<double>(found), most, false, "", ""};
}

void check_tets(const HeadTemplate& head, HeadReport& report) {
  const VectorXd volumes = tet_volumes(head.volume.V, head.volume.T);
  report.gates.push_back(count("inverted tets", static_cast<std::size_t>((volumes.array() <= 0).count()), 0));
  Gate dihedral{"smallest dihedral angle", 180, 5, true, "degrees", ""};
  Eigen::Index flat = 0;
  for (Eigen::Index t = 0; t < head.volume.T.rows(); ++t) {
    const auto at = [&](int k) { return Vector3d(head.volume.V.row(head.volume.T(t, k))); };
    const double angle = dihedral_range(at(0), at(1), at(2), at(3))[0];
    flat += angle < dihedral.bound ? 1 : 0;
    dihedral.measured = std::min(dihedral.measured, angle);
  }
  if (flat > 0) dihedral.note = fmt::format("{} of {} tets are below", flat, head.volume.T.rows());
  report.gates.push_back(dihedral);
}

void check_bones(const HeadTemplate& head, HeadReport& report) {
  report.gates.push_back({"simulated bones inside the skin", mm * simulated_bone_depth(head), 1, true, "mm", ""});
  report.gates.push_back({"drawn bones inside the skin", mm * drawn_bone_depth(head), 1, true, "mm", ""});
  report.thickness = measured_thickness(head);
  Gate mean{"flesh thickness, mean difference", 0, 2.5, false, "mm", ""};
  double worst = -1;
  for (const MeasuredThickness& t : report.thickness) {
    const double off = mm * std::abs(t.measured - t.usual);
    mean.measured += off / static_cast<double>(report.thickness.size());
    if (off > worst || std::isnan(off)) {
      worst = off;
      mean.note = fmt::format("worst: {} {:.1f} mm, usual {:.1f}", t.name, mm * t.measured, mm * t.usual);
    }
  }
  report.gates.push_back(mean);
  report.gates.push_back({"thickness landmarks", static_cast<double>(report.thickness.size()), 16, true, "", ""});
}

void check_muscles(const HeadTemplate& head, HeadReport& report) {
  for (const Muscle& muscle : head.muscles) report.muscles.push_back(muscle_figures(head, muscle));
  Gate inside{"muscles inside the flesh, least", 1, 0.95, true, "", ""};
  Gate angle{"fibre directions, largest median", 0, 25, false, "degrees", ""};
  for (const MuscleFigures& m : report.muscles) {
    if (m.share_in_flesh < inside.measured) inside.measured = m.share_in_flesh, inside.note = m.name;
    if (!(m.angle <= angle.measured)) angle.measured = m.angle, angle.note = m.name;
  }
  report.gates.push_back(inside);
  report.gates.push_back(angle);
  report.active_share = active_share(head);
  report.active_share_of_face = active_share_of_face(head);
}

void check_presence(const HeadTemplate& head, HeadReport& report) {
  std::vector<std::string> marks;
  for (int i = 0; i < 68; ++i) marks.push_back(std::to_string(i));
  report.gates.push_back(presence("expressions", expression_names, names_of(head.expressions)));
  report.gates.push_back(presence("landmarks", marks, names_of(head.landmarks)));
  report.gates.push_back(presence("muscles of expression", expression_muscle_names(), names_of(head.muscles)));
  for (const auto& [hold, name] : {std::pair{Hold::pin, "pins"}, std::pair{Hold::slide, "slides"}}) {
    const auto found = (head.attachments.hold.array() == static_cast<int>(hold)).count();
    report.gates.push_back({name, static_cast<double>(found), 1, true, "", ""});
  }
}

}  // namespace

std::string readable(const Gate& gate) {
  return fmt::format("{:<5} {:<36} {:>8.4g}{}{} ({} {:g}){}{}", gate.holds() ? "ok" : "FAILS", gate.name, gate.measured,
                     gate.unit.empty() ? "" : " ", gate.unit, gate.at_least ? "at least" : "at most", gate.bound,
                     gate.note.empty() ? "" : ": ", gate.note);
}

bool HeadReport::passes() const {
  return std::all_of(gates.begin(), gates.end(), [](const Gate& gate) { return gate.holds(); });
}

HeadReport check_head(const HeadTemplate& head, const std::function<void(const std::string&)>& report) {
  const auto step = [&report](const char* name) {
    if (report) report(name);
  };
  HeadReport result;
  step("tets");
  check_tets(head, result);
  step("bones and thickness");
  check_bones(head, result);
  step("muscles");
  check_muscles(head, result);
  step("skin");
  result.gates.push_back(count("self-intersections of the skin", self_intersections(simulation_skin(head)).size(), 0));
  result.drawn_skin_self_intersections = self_intersections(head.skin).size();
  result.occlusion = occlusion(head);
  result.gates.push_back(
      {"teeth in each other",
       result.occlusion.known ? mm * result.occlusion.interpenetration : std::numeric_limits<double>::infinity(), 0.3,
       false, "mm", result.occlusion.known ? "" : "upperTeeth or lowerTeeth is missing"});
  check_presence(head, result);
  step("expressions");
  result.expressions = expression_figures(head);
  return result;
}

}  // namespace phiz
