// SPDX-License-Identifier: GPL-3.0-or-later
// phiz simulate: forward physics. Muscles move a face; contact, inertia, gravity, wind and rigid objects act on it.
#include "phiz/face/simulate.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <initializer_list>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "inputs.h"
#include "object_options.h"
#include "options.h"
#include "phiz/core/error.h"
#include "phiz/core/nearest_words.h"
#include "phiz/core/progress.h"
#include "phiz/io/container.h"
#include "phiz/io/output_file.h"
#include "phiz/io/rigid_path_file.h"
#include "phiz/io/take_file.h"
#include "report.h"
#include "take_notes.h"
#include "verbs.h"

namespace phiz {

namespace {

struct SimulateArguments {
  std::string model, performance, output, save_model, frames, trace, head_path;
  std::vector<std::string> weights, paralysed;
  std::optional<double> seconds, ramp, frame_rate;
  std::string gravity, wind, gust, passive = "corotated";
  ObjectArguments object;
  bool dynamic = false, no_contact = false;
  double damping = MuscleOptions().damping;
  double time_step_ms = 1e3 * MuscleOptions().time_step;
  double tolerance_mm = 1e3 * TissueSolverOptions().step_tolerance;
  double shear_kpa = 1e-3 * TissueOptions().shear_scale;
  double muscle_stiffness = TissueOptions().muscle_stiffness;
  Report report;
};

void set_muscles(const SimulateArguments& a, MuscleOptions& options) {
  options.contact = !a.no_contact;
  options.dynamic = a.dynamic;
  options.damping = a.damping;
  options.time_step = 1e-3 * a.time_step_ms;
  if (!a.gravity.empty()) options.gravity = three_numbers(a.gravity, "--gravity");
  if (!a.wind.empty()) options.air.wind = three_numbers(a.wind, "--wind");
  options.tissue.shear_scale = 1e3 * a.shear_kpa;
  options.tissue.muscle_stiffness = a.muscle_stiffness;
  options.tissue.passive = a.passive == "neo-hookean" ? PassiveLaw::neo_hookean : PassiveLaw::corotated;
  options.solve.step_tolerance = 1e-3 * a.tolerance_mm;
}

/// Options that depend on nothing but the command line.
SimulateOptions simulate_options(const SimulateArguments& a) {
  SimulateOptions options;
  set_muscles(a, options.muscles);
  options.paralysed = a.paralysed;
  if (!a.gust.empty()) {
    if (a.wind.empty()) misuse("--gust needs --wind");
    const auto [share, period] = two_numbers(a.gust, ',', "--gust", "SHARE,PERIOD, e.g. 0.5,0.8");
    if (share < 0 || share > 10 || !(period > 0))
      misuse("--gust: SHARE must be from 0 to 10 and PERIOD above 0 seconds");
    options.gusts = {share, period};
  }
  if (!a.dynamic && (a.damping > 0 || a.time_step_ms != SimulateArguments().time_step_ms))
    misuse("--damping and --time-step need --dynamic");
  if (a.no_contact && !a.object.file.empty()) misuse("--object needs contact; leave --no-contact out");
  if (!a.performance.empty() && (!a.weights.empty() || a.seconds || a.ramp))
    misuse("--weights, --seconds and --ramp take the place of a performance; give one or the other");
  return options;
}

Performance performance_of(const SimulateArguments& a) {
  constexpr double usual_rate = 60;
  if (a.performance.empty())
    return held_expression(named_weights(a.weights, "--weights"), a.seconds.value_or(0),
                           a.frame_rate.value_or(usual_rate), a.ramp.value_or(0));
  const Performance performance = load_any_performance(a.performance);
  return a.frame_rate ? resample(performance, *a.frame_rate) : performance;
}

/// Weights of the command line must be of the model; a performance may know more than a model.
void check_weights(const SimulateArguments& a, const FaceModel& model, const ExpressionMatch& match) {
  if (!a.performance.empty()) return announce_mismatch(match);
  if (match.unmatched.empty()) return;
  std::vector<std::string> names;
  for (const VolumetricShape& shape : model.shapes) names.push_back(shape.name);
  const std::vector<std::string> near = nearest_words(match.unmatched.front(), names, 1);
  misuse(fmt::format("--weights: the model has no expression '{}'{}", match.unmatched.front(),
                     near.empty() ? "" : fmt::format("; did you mean '{}'?", near.front())));
}

/// The iterations of the solver as a table.
class TraceTable {
 public:
  void add(int frame, const Trace& trace) {
    for (const TraceEntry& e : trace)
      text_ +=
          fmt::format("{},{},{},{:.9g},{:.6g},{},{:.6g},{:.6g},{:.6g},{:.4g}\n", frame, e.iteration, e.round, e.energy,
                      e.residual, e.contacts, 1e3 * e.violation, e.step_length, 1e3 * e.last_step, e.milliseconds);
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_ = "frame,iteration,round,energy_j,residual,contacts,violation_mm,step_share,step_mm,ms\n";
};

void run_simulate(const SimulateArguments& a) {
  const std::initializer_list<std::string> inputs = {a.model, a.performance, a.object.file, a.object.path, a.head_path};
  for (const std::string& output : {a.output, a.save_model, a.trace, a.report.json == "-" ? "" : a.report.json})
    if (!output.empty()) protect_inputs(output, inputs);
  protect_inputs(a.output, {a.save_model});
  SimulateOptions options = simulate_options(a);
  const Performance performance = performance_of(a);
  if (!a.frames.empty()) {
    const FrameRange frames = frame_range(a.frames);
    if (frames.end > performance.time.size())
      misuse(fmt::format("--frames {}: there are {} frames", a.frames, performance.time.size()));
    options.first_frame = frames.first;
    options.end_frame = frames.end;
  }
  if (const auto object = load_object(a.object)) options.objects.push_back(*object);
  if (!a.head_path.empty()) options.head_path = read_rigid_path(a.head_path);
  for (const std::string& output : {a.output, a.save_model, a.trace})
    if (!output.empty()) require_writable(output);
  const FaceModel model = load_model(a.model);
  check_weights(a, model, match_expressions(model, performance));
  if (!a.save_model.empty()) save(a.save_model, model);

  const Take head = empty_take(model, performance, options);
  Trace iterations;
  if (!a.trace.empty()) options.muscles.solve.trace = &iterations;
  TraceTable trace;
  TakeNotes notes;
  std::optional<TakeWriter> writer;  // from the first frame on there is something to keep
  catch_interrupts();
  {
    Progress progress("frames", head.frames_planned);
    simulate(model, performance, options, [&](const TakeFrame& frame, int number) {
      if (!writer) writer.emplace(a.output, head);
      writer->append(frame);
      notes.note(frame, number);
      trace.add(number, iterations);
      iterations.clear();
      progress.advance();
      return true;
    });
  }
  if (!writer) fail("stopped before the first frame");
  const int done = writer->frames();
  writer->finish();
  if (!a.trace.empty()) write_bytes(a.trace, trace.text());

  nlohmann::json report = notes.report();
  report["take"] = a.output;
  report["model"] = model.head.name;
  report["dynamic"] = a.dynamic;
  report["frames_planned"] = head.frames_planned;
  report["frame_rate"] = head.frame_rate;
  a.report.write(report);
  if (done < head.frames_planned)
    fail(fmt::format("stopped after {} of {} frames, which are kept in {}", done, head.frames_planned, a.output),
         "a simulation cannot be resumed; --frames FIRST:END simulates a part");
  a.report.print(fmt::format("{}: {}\n", a.output, notes.brief()));
}

void add_play_options(CLI::App& verb, SimulateArguments& a) {
  verb.add_option("MODEL", a.model, "A head or a face model, a .phiz file")->required();
  verb.add_option("PERFORMANCE", a.performance,
                  "A recording of Live Link Face (CSV), or a .phiz performance; without, the expression of --weights");
  verb.add_option("-o,--output", a.output, "The take, a .phiz file")->required()->check(phiz_name())->type_name("FILE");
  verb.add_option("--weights", a.weights, "An expression instead of a performance, e.g. jawOpen=0.5,mouthSmileLeft=1")
      ->delimiter(',')
      ->type_name("NAME=WEIGHT,...");
  verb.add_option("--seconds", a.seconds, "How long the expression is shown; without, one frame")
      ->check(between(0, 3600));
  verb.add_option("--ramp", a.ramp, "Seconds in which it comes from neutral")->check(between(0, 3600));
  verb.add_option("--frames", a.frames, "Frames FIRST to END - 1 only")->type_name("FIRST:END");
  verb.add_option("--fps", a.frame_rate, "Resample the performance to this frame rate; of an expression: 60 without")
      ->check(between(1, 1000));
  verb.add_option("--head-path", a.head_path,
                  "Moves the head, on top of the performance: a table (CSV) as that of --object-path")
      ->type_name("CSV");
}

void add_physics_options(CLI::App& verb, SimulateArguments& a) {
  verb.add_flag("--dynamic", a.dynamic, "With inertia; without, every frame is in balance");
  verb.add_option("--damping", a.damping, "How fast motion relative to the head dies out by itself, 1/s")
      ->check(between(0, 1e4))
      ->capture_default_str();
  verb.add_option("--time-step", a.time_step_ms, "Of dynamics, milliseconds; frames are divided into such steps")
      ->check(between(0.05, 1000))
      ->type_name("MS")
      ->default_str(fmt::format("{:.3g}", a.time_step_ms));
  verb.add_option("--gravity", a.gravity, "m/s^2, e.g. 0,-9.81,0; the head is at rest without")->type_name("X,Y,Z");
  verb.add_option("--wind", a.wind, "Metres per second in the world; +x is the person's left, +z ahead")
      ->type_name("X,Y,Z");
  verb.add_option("--gust", a.gust, "The wind blows with 1 + SHARE sin(2 pi t / PERIOD) times its speed; seconds")
      ->type_name("SHARE,PERIOD");
  add_object_options(verb, a.object);
  verb.add_flag("--no-contact", a.no_contact, "Let lips and teeth pass through each other");
  verb.add_option("--paralyse", a.paralysed,
                  "left or right (half of the face), or muscles; without Left or Right: both sides")
      ->delimiter(',')
      ->type_name("NAME,...");
  verb.add_option("--shear-kpa", a.shear_kpa, "Shear scale E0 of the flesh, kilopascals")
      ->check(between(0.01, 1e4))
      ->type_name("KPA")
      ->capture_default_str();
  verb.add_option("--muscle-stiffness", a.muscle_stiffness, "How many times stiffer muscle is than passive tissue")
      ->check(between(0.01, 1000))
      ->type_name("RATIO")
      ->capture_default_str();
  verb.add_option("--passive", a.passive, "Law of passive tissue")
      ->check(CLI::IsMember({"corotated", "neo-hookean"}))
      ->capture_default_str();
}

}  // namespace

void add_simulate(CLI::App& app) {
  CLI::App* verb =
      app.add_subcommand("simulate", "Move a face by its muscles, with contact, inertia, gravity, wind and objects");
  auto a = std::make_shared<SimulateArguments>();
  add_play_options(*verb, *a);
  add_physics_options(*verb, *a);
  verb->add_option("--tolerance", a->tolerance_mm,
                   "Accuracy: a solve ends when an iteration moves no vertex by more, millimetres")
      ->check(between(1e-4, 1))
      ->type_name("MM")
      ->capture_default_str();
  verb->add_option("--trace", a->trace, "Write every iteration of the solver to a table (CSV)")->type_name("FILE");
  verb->add_option("--save-model", a->save_model, "Keep the face model made from a head: using it starts at once")
      ->check(phiz_name())
      ->type_name("FILE");
  add_report(*verb, a->report);
  verb->footer(
      "Ctrl-C keeps the finished frames; a simulation cannot be resumed.\n\n"
      "Examples:\n"
      "  phiz simulate head.phiz performance.csv -o take.phiz --dynamic --damping 5 --save-model model.phiz\n"
      "  phiz simulate model.phiz --weights mouthSmileLeft=1,mouthSmileRight=1 -o smile.phiz --paralyse left\n"
      "  phiz simulate model.phiz --seconds 1 --dynamic --wind 0,0,-30 --gust 0.5,0.4 -o wind.phiz\n"
      "  phiz simulate model.phiz --seconds 0.5 --dynamic --object ball.obj --object-path punch.csv -o punch.phiz");
  verb->callback([a] { run_simulate(*a); });
}

}  // namespace phiz
