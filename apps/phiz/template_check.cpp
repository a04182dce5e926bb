// SPDX-License-Identifier: GPL-3.0-or-later
// phiz template check: measures a head against its gates.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "phiz/anatomy/check_head.h"
#include "phiz/core/error.h"
#include "phiz/core/progress.h"
#include "phiz/io/container.h"
#include "report.h"
#include "verbs.h"

namespace phiz {

namespace {

using nlohmann::json;

constexpr double mm = 1e3, ml = 1e6;

json described(const HeadReport& report) {
  json gates = json::array(), thickness = json::array(), muscles = json::array(), expressions = json::object();
  for (const Gate& g : report.gates)
    gates.push_back({{"name", g.name},
                     {"measured", g.measured},
                     {"bound", g.bound},
                     {"at_least", g.at_least},
                     {"unit", g.unit},
                     {"note", g.note},
                     {"holds", g.holds()}});
  for (const MeasuredThickness& t : report.thickness)
    thickness.push_back({{"name", t.name},
                         {"measured_mm", mm * t.measured},
                         {"usual_mm", mm * t.usual},
                         {"deviation_mm", mm * t.deviation}});
  for (const MuscleFigures& m : report.muscles)
    muscles.push_back({{"name", m.name},
                       {"volume_ml", ml * m.volume},
                       {"share_in_flesh", m.share_in_flesh},
                       {"angle_degrees", m.angle}});
  for (const ExpressionFigures& e : report.expressions) expressions[e.name] = e.self_intersections;
  const Occlusion& o = report.occlusion;
  return {{"passes", report.passes()},
          {"gates", gates},
          {"thickness", thickness},
          {"muscles", muscles},
          {"active_share", report.active_share},
          {"active_share_of_face", report.active_share_of_face},
          {"occlusion",
           {{"known", o.known},
            {"overbite_mm", mm * o.overbite},
            {"overjet_mm", mm * o.overjet},
            {"gap_mm", mm * o.gap},
            {"interpenetration_mm", mm * o.interpenetration}}},
          {"drawn_skin_self_intersections", report.drawn_skin_self_intersections},
          {"expression_self_intersections", expressions}};
}

std::string readable(const HeadReport& report) {
  std::string text;
  for (const Gate& gate : report.gates) text += readable(gate) + "\n";
  text += "\nflesh thickness, mm: measured (usual)\n";
  for (const MeasuredThickness& t : report.thickness)
    text += fmt::format("  {:<26} {:5.1f} ({:.1f})\n", t.name, mm * t.measured, mm * t.usual);
  text += "\nmuscles: volume, share in flesh, median angle of the fibres to the muscle's axis\n";
  for (const MuscleFigures& m : report.muscles)
    text +=
        fmt::format("  {:<38} {:6.2f} ml  {:.3f}  {:4.1f} degrees\n", m.name, ml * m.volume, m.share_in_flesh, m.angle);
  text += fmt::format("  active share: {:.3f} of all flesh, {:.3f} of the face's\n", report.active_share,
                      report.active_share_of_face);
  const Occlusion& o = report.occlusion;
  if (o.known)
    text += fmt::format(
        "\nocclusion: overbite {:.1f} mm, overjet {:.1f} mm, gap {:.2f} mm, teeth in each other {:.2f} mm\n",
        mm * o.overbite, mm * o.overjet, mm * o.gap, mm * o.interpenetration);
  text += fmt::format("self-intersections of the drawn skin at rest: {} pairs of triangles\n",
                      report.drawn_skin_self_intersections);
  text += "self-intersections of the simulation skin at weight 1:";
  std::size_t clean = 0;
  for (const ExpressionFigures& e : report.expressions) {
    if (e.self_intersections == 0)
      ++clean;
    else
      text += fmt::format(" {} {},", e.name, e.self_intersections);
  }
  return text + fmt::format(" none in {} of {} expressions\n", clean, report.expressions.size());
}

}  // namespace

void add_template_check(CLI::App& verb) {
  struct Arguments {
    std::string file;
    Report report;
  };
  CLI::App* check = verb.add_subcommand("check", "Measure a head against the gates that a good one passes");
  auto arguments = std::make_shared<Arguments>();
  check->add_option("FILE", arguments->file, "A head or a model, a .phiz file")->required();
  add_report(*check, arguments->report);
  check->footer("Exit code 0 only if every gate holds.\nExample:\n  phiz template check head.phiz --json gates.json");
  check->callback([arguments] {
    const HeadTemplate head = load_head_template(arguments->file);
    const HeadReport report = check_head(head, announce);
    arguments->report.print(readable(report));
    json description = described(report);
    description["file"] = arguments->file;
    description["name"] = head.name;
    arguments->report.write(description);
    std::string failed;
    for (const Gate& gate : report.gates)
      if (!gate.holds()) failed += (failed.empty() ? "" : ", ") + gate.name;
    if (!failed.empty()) fail(arguments->file + " does not pass: " + failed);
  });
}

}  // namespace phiz
