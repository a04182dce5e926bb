// SPDX-License-Identifier: GPL-3.0-or-later
// phiz animate: a head plays a performance; every frame is solved and kept.
#include "phiz/face/animate.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "inputs.h"
#include "options.h"
#include "phiz/core/error.h"
#include "phiz/core/progress.h"
#include "phiz/io/container.h"
#include "phiz/io/output_file.h"
#include "phiz/io/take_file.h"
#include "report.h"
#include "take_notes.h"
#include "verbs.h"

namespace phiz {

namespace {

struct AnimateArguments {
  std::string model;
  std::string performance;
  std::string output;
  std::string save_model;
  std::string frames;
  std::optional<double> frame_rate;
  bool resume = false;
  bool dynamic = false;
  bool no_contact = false;
  Report report;
};

/// Refuses a frame of the take at `path` that was not made from this performance, or not in this way.
void require_same_making(const TakeFrame& frame, int number, const FaceModel& model, const Performance& performance,
                         const AnimateOptions& options, const std::string& path) {
  const char* const mend = "choose another file or start anew, without --resume";
  const VectorXd weights = shape_weights(match_expressions(model, performance), performance, number);
  if (frame.time != performance.time[number] || frame.part_weights != weights)
    reject(path, fmt::format("its frame for {:.3f} s was made from another performance", frame.time), mend);
  const bool dynamic = frame.velocity.rows() > 0;
  if (dynamic != options.simulation.dynamic)
    reject(path, fmt::format("the take there was made with{} --dynamic", dynamic ? "" : "out"), mend);
}

void animate_model(const AnimateArguments& arguments) {
  protect_inputs(arguments.output, {arguments.model, arguments.performance, arguments.save_model});
  protect_inputs(arguments.save_model, {arguments.model, arguments.performance});
  Performance performance = load_any_performance(arguments.performance);
  if (arguments.frame_rate) performance = resample(performance, *arguments.frame_rate);
  AnimateOptions options;
  options.simulation.dynamic = arguments.dynamic;
  options.simulation.contact = !arguments.no_contact;
  if (!arguments.frames.empty()) {
    const FrameRange frames = frame_range(arguments.frames);
    if (frames.end > performance.time.size())
      misuse(fmt::format("--frames {}: {} has {} frames", arguments.frames, arguments.performance,
                         performance.time.size()));
    options.first_frame = frames.first;
    options.end_frame = frames.end;
  }
  require_writable(arguments.output);
  if (!arguments.save_model.empty()) require_writable(arguments.save_model);
  const FaceModel model = load_model(arguments.model);
  if (!arguments.save_model.empty()) save(arguments.save_model, model);

  announce_mismatch(match_expressions(model, performance));

  const Take head = empty_take(model, performance, options);
  std::vector<TakeFrame> finished;
  const auto keep = [&](const TakeFrame& frame) {
    require_same_making(frame, options.first_frame + static_cast<int>(finished.size()), model, performance, options,
                        arguments.output);
    finished.push_back(frame);
    finished.back().skin.resize(0, 3);
    const int count = static_cast<int>(finished.size());
    if (last_key_frame(count) == count) return;  // to go on from a key frame takes the state before it
    finished.back().volume.resize(0, 3);
    finished.back().velocity.resize(0, 3);
  };
  TakeWriter writer =
      arguments.resume ? TakeWriter::resume(arguments.output, head, keep) : TakeWriter(arguments.output, head);
  catch_interrupts();  // from here on there are frames to keep
  TakeNotes notes;
  for (std::size_t f = 0; f < finished.size(); ++f) notes.note(finished[f], options.first_frame + static_cast<int>(f));
  {
    Progress progress("frames", head.frames_planned);
    progress.advance(static_cast<std::ptrdiff_t>(finished.size()));
    animate(model, performance, options, finished, [&](const TakeFrame& frame, int number) {
      writer.append(frame);
      notes.note(frame, number);
      progress.advance();
      return true;
    });
  }
  const int done = writer.frames();
  writer.finish();

  nlohmann::json report = notes.report();
  report["take"] = arguments.output;
  report["model"] = model.head.name;
  report["frames_planned"] = head.frames_planned;
  report["frame_rate"] = head.frame_rate;
  arguments.report.write(report);
  if (done < head.frames_planned)
    fail(
        fmt::format("stopped after {} of {} frames, which are kept in {}", done, head.frames_planned, arguments.output),
        "the same command with --resume goes on");
  arguments.report.print(fmt::format("{}: {}\n", arguments.output, notes.brief()));
}

}  // namespace

void add_animate(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("animate", "Let a head play a performance, with physics in every frame");
  auto arguments = std::make_shared<AnimateArguments>();
  verb->add_option("MODEL", arguments->model, "A head or a face model, a .phiz file")->required();
  verb->add_option("PERFORMANCE", arguments->performance, "A recording of Live Link Face (CSV), or a .phiz performance")
      ->required();
  verb->add_option("-o,--output", arguments->output, "The take, a .phiz file")
      ->required()
      ->check(phiz_name())
      ->type_name("FILE");
  verb->add_option("--frames", arguments->frames, "Frames FIRST to END - 1 of the performance only")
      ->type_name("FIRST:END");
  verb->add_option("--fps", arguments->frame_rate, "Resample the performance to this frame rate")
      ->check(between(1, 1000));
  verb->add_flag("--resume", arguments->resume, "Go on with an interrupted take");
  verb->add_flag("--dynamic", arguments->dynamic, "With inertia; without, every frame is in balance");
  verb->add_flag("--no-contact", arguments->no_contact, "Let lips and teeth pass through each other");
  verb->add_option("--save-model", arguments->save_model,
                   "Keep the face model made from a head: animating it starts at once")
      ->check(phiz_name())
      ->type_name("FILE");
  add_report(*verb, arguments->report);
  verb->footer(
      "Ctrl-C keeps the finished frames; the same command with --resume completes the take.\n\n"
      "Example:\n  phiz animate head.phiz performance.csv -o take.phiz --json report.json");
  verb->callback([arguments] { animate_model(*arguments); });
}

}  // namespace phiz
