// SPDX-License-Identifier: GPL-3.0-or-later
// phiz render: pictures, contact sheets and films of meshes, heads and takes.
#include "phiz/render/render.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "object_options.h"
#include "options.h"
#include "phiz/core/error.h"
#include "phiz/core/progress.h"
#include "phiz/io/file_bytes.h"
#include "phiz/io/output_file.h"
#include "phiz/io/png.h"
#include "phiz/io/text_scanner.h"
#include "phiz/render/contact_sheet.h"
#include "phiz/render/film.h"
#include "render_subject.h"
#include "report.h"
#include "verbs.h"

namespace phiz {

namespace {

struct RenderArguments {
  SubjectOptions subject;
  ObjectArguments object;
  std::string output, style = "clay", frames, size, cut, peel, range, quality = "normal";
  std::vector<std::string> views, expressions;
  int frame = -1;
  double fps = 0;
  bool sheet = false, all_expressions = false;
  Report report;
};

struct Extent {
  int width, height;
};

Extent extent_of(const std::string& size, int otherwise) {
  if (size.empty()) return {otherwise, otherwise};
  const auto [w, h] = two_numbers(size, 'x', "--size", "WIDTHxHEIGHT");
  if (!(w >= 16 && h >= 16 && w <= 16384 && h <= 16384)) misuse("--size must be 16 to 16384 pixels either way");
  return {static_cast<int>(w), static_cast<int>(h)};
}

/// "x=4": the part with x above 4 mm is taken away; "-x=4": the part below.
CutPlane cut_plane(const std::string& option, const std::string& text) {
  const std::size_t at = text.find('=');
  const std::string axis = text.substr(0, at);
  const auto offset = at == std::string::npos ? std::nullopt : parse_number(text.substr(at + 1));
  const bool turned = !axis.empty() && axis[0] == '-';
  const std::string letter = turned ? axis.substr(1) : axis;
  if (!offset || !std::isfinite(*offset) || (letter != "x" && letter != "y" && letter != "z"))
    misuse(option + " '" + text + "' is not of the form AXIS=MILLIMETRES, e.g. x=4 or -y=-30");
  CutPlane plane;
  plane.normal = Vector3d::Unit(letter[0] - 'x') * (turned ? -1 : 1);
  plane.point = Vector3d::Unit(letter[0] - 'x') * (*offset / 1000);
  return plane;
}

RenderOptions rays(const std::string& quality, bool film) {
  RenderOptions options = film ? film_options() : still_options();
  if (quality == "draft") {
    options.samples = 3;
    options.ambient_samples = 2;
    options.light_samples = 1;
  } else if (quality == "fine") {
    options.samples = film ? 12 : 36;
    options.ambient_samples = film ? 12 : 36;
    options.light_samples = film ? 4 : 8;
  }
  return options;
}

FrameRange frames_of(const RenderArguments& a, const Subject& subject) {
  if (a.frames.empty()) return {0, subject.frames};
  const FrameRange frames = frame_range(a.frames);
  if (frames.end > subject.frames)
    misuse(fmt::format("--frames {} is not within the frames 0:{} of {}", a.frames, subject.frames, a.subject.file));
  return frames;
}

/// With the bar of a heat map.
Image picture(const Subject& subject, int frame, View view, Extent extent, const RenderOptions& options) {
  Image image =
      render(subject.scene(frame, is_close_up(view)), subject.camera(view, extent.width, extent.height), options);
  if (subject.has_legend) draw_legend(image, subject.scale);
  return image;
}

/// What the names beside a picture leave of the extent, at least half.
Extent beside_names(const Subject& subject, Extent extent) {
  return {std::max(extent.width - legend_width(subject.names, extent.height), extent.width / 2), extent.height};
}

std::string frame_caption(const Subject& subject, int frame) {
  return subject.frame_rate > 0 ? fmt::format("frame {}, {:.2f} s", frame, frame / subject.frame_rate) : "";
}

/// Frames of a take, expressions or views of a head.
Image make_sheet(const RenderArguments& a, const Subject& subject, std::vector<View> views) {
  catch_interrupts();
  const Extent extent = extent_of(a.size, 380);
  const RenderOptions options = rays(a.quality, false);
  std::vector<SheetCell> cells;
  if (a.all_expressions) {
    if (!subject.express || subject.expressions.empty()) misuse("--all-expressions needs a head with expressions");
    const View view = views.empty() ? View::face : views.front();
    std::vector<std::string> names = subject.expressions;
    names.insert(names.begin(), "neutral");
    Progress progress("render", static_cast<std::ptrdiff_t>(names.size()));
    for (const std::string& name : names) {
      if (interrupted()) break;
      std::map<std::string, double> weights;
      if (name != "neutral") weights[name] = 1;
      // It closes the lips of an open jaw, and means nothing without.
      const bool on_open_jaw = name == "mouthClose" && std::find(names.begin(), names.end(), "jawOpen") != names.end();
      if (on_open_jaw) weights["jawOpen"] = 1;
      subject.express(weights);
      cells.push_back({picture(subject, 0, view, extent, options), on_open_jaw ? "jawOpen + mouthClose" : name});
      progress.advance();
    }
  } else if (subject.frames > 1 && a.frame < 0) {
    if (views.empty()) views = {View::three_quarter};
    const FrameRange range = frames_of(a, subject);
    const int most = views.size() > 1 ? 6 : 12, count = std::min(most, range.end - range.first);
    Progress progress("render", static_cast<std::ptrdiff_t>(count) * static_cast<std::ptrdiff_t>(views.size()));
    for (const View view : views) {
      for (int i = 0; i < count && !interrupted(); ++i) {
        const int frame = range.first + (2 * i + 1) * (range.end - range.first) / (2 * count);
        cells.push_back({picture(subject, frame, view, extent, options), frame_caption(subject, frame)});
        progress.advance();
      }
    }
  } else {
    if (views.empty())
      views = {View::front, View::three_quarter, View::side,     View::back,
               View::face,  View::mouth,         View::left_eye, View::ear};
    Progress progress("render", static_cast<std::ptrdiff_t>(views.size()));
    for (const View view : views) {
      if (interrupted()) break;
      cells.push_back({picture(subject, std::max(a.frame, 0), view, extent, options), std::string(view_name(view))});
      progress.advance();
    }
  }
  if (cells.empty()) fail("interrupted before the first picture");
  const std::string what = a.subject.view.style == HeadStyle::heat ? subject.scale.quantity : a.style;
  const int in_a_row = cells.size() <= 3 ? static_cast<int>(cells.size()) : 0;
  return with_legend(contact_sheet(cells, {.title = subject.name + " - " + what, .columns = in_a_row}), subject.names);
}

/// Frames of a take at the film's rate, or a turn of what does not move. Returns the number of frames.
int make_film(const RenderArguments& a, const Subject& subject, View view) {
  catch_interrupts();
  const Extent extent = beside_names(subject, extent_of(a.size, 640));
  const RenderOptions options = rays(a.quality, true);
  const bool moving = subject.frames > 1;
  const FrameRange range = frames_of(a, subject);
  const double source_rate = moving ? subject.frame_rate : 30, rate = a.fps > 0 ? a.fps : source_rate;
  const int count = moving ? static_cast<int>(std::ceil((range.end - range.first) * rate / source_rate - 1e-9))
                           : static_cast<int>(std::lround(4 * rate));
  const Camera camera = subject.camera(view, extent.width, extent.height);
  FilmWriter film(a.output, {.frame_rate = rate});
  Progress progress("render", count);
  for (int k = 0; k < count && !interrupted(); ++k) {
    Camera placed = camera;
    int frame = 0;
    if (moving) {
      frame = std::min(range.end - 1, range.first + static_cast<int>(k * source_rate / rate + 1e-9));
    } else {
      const Eigen::AngleAxisd turn(2 * M_PI * k / count, Vector3d::UnitY());
      placed.eye = camera.target + turn * (camera.eye - camera.target);
    }
    Image image = render(subject.scene(frame, is_close_up(view)), placed, options);
    if (subject.has_legend) draw_legend(image, subject.scale);
    film.add(with_legend(image, subject.names));
    progress.advance();
  }
  film.finish();
  return film.frames();
}

/// Options that the style would not heed are mistakes.
void check_style(const HeadViewOptions& view) {
  const HeadStyle s = view.style;
  const bool layers = s == HeadStyle::muscles || s == HeadStyle::fibres;
  if ((!view.muscles.empty() || view.muscle_colours) && !layers && s != HeadStyle::cutaway && s != HeadStyle::anatomy)
    misuse("--muscle and --muscle-colours need --style muscles, fibres, cutaway or anatomy");
  if (view.peel && !layers && s != HeadStyle::attachments && s != HeadStyle::contacts)
    misuse("--peel needs --style muscles, fibres, attachments or contacts");
}

void run_render(RenderArguments a) {
  const auto start = std::chrono::steady_clock::now();
  const std::string extension = lower_extension(a.output);
  const bool film = extension == ".mp4";
  if (!film && extension != ".png") misuse("the output '" + a.output + "' must end in .png or .mp4");
  if (film && (a.sheet || a.all_expressions)) misuse("a sheet is a picture; give an output that ends in .png");
  if (!a.subject.quantity.empty() || !a.subject.values.empty()) a.style = "heat";
  a.subject.view.style = head_style(a.style);
  if (!a.cut.empty()) a.subject.view.plane = cut_plane("--cut", a.cut);
  if (!a.peel.empty()) a.subject.view.peel = cut_plane("--peel", a.peel);
  check_style(a.subject.view);
  if (!a.range.empty()) {
    std::tie(a.subject.low, a.subject.high) = two_numbers(a.range, ':', "--range", "LOW:HIGH");
    if (!(a.subject.low < a.subject.high)) misuse("--range must go from a lower to a higher number");
  }
  a.subject.view.expressions = named_weights(a.expressions, "--expression");
  std::vector<View> views;
  for (const std::string& name : a.views) views.push_back(view_from_name(name));

  // Mistakes are told before anything is opened, let alone rendered.
  extent_of(a.size, 0);
  a.subject.object = load_object(a.object);
  if (!a.frames.empty()) frame_range(a.frames);
  const Subject subject = open_subject(a.subject);
  require_writable(a.output);
  if (a.frame >= subject.frames)
    misuse(
        fmt::format("--frame {} is not within the frames 0 to {} of {}", a.frame, subject.frames - 1, a.subject.file));
  const View first = !views.empty()                               ? views.front()
                     : a.subject.view.style == HeadStyle::cutaway ? View::side
                                                                  : View::three_quarter;
  int frames = 1;
  if (film) {
    frames = make_film(a, subject, first);
  } else if (a.sheet || a.all_expressions || views.size() > 1) {
    write_png(a.output, make_sheet(a, subject, views));
  } else {
    const FrameRange range = frames_of(a, subject);
    const Extent extent = beside_names(subject, extent_of(a.size, 800));
    const Image image = picture(subject, a.frame >= 0 ? a.frame : range.first, first, extent, rays(a.quality, false));
    write_png(a.output, with_legend(image, subject.names));
  }
  if (interrupted()) fail("stopped; what is finished is kept in " + a.output);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  a.report.print(film ? fmt::format("{}: {} frames, {:.1f} s\n", a.output, frames, seconds)
                      : fmt::format("{}: {:.1f} s\n", a.output, seconds));
  nlohmann::json report = {
      {"file", a.output}, {"source", a.subject.file}, {"frames", frames}, {"style", a.style}, {"seconds", seconds}};
  if (subject.has_legend)
    report["scale"] = {{"quantity", subject.scale.quantity},
                       {"unit", subject.scale.unit},
                       {"low", subject.scale.low},
                       {"high", subject.scale.high}};
  a.report.write(report);
}

}  // namespace

void add_render(CLI::App& app) {
  CLI::App* verb =
      app.add_subcommand("render", "Make a picture, a contact sheet or a film of a mesh, a head or a take");
  auto a = std::make_shared<RenderArguments>();
  std::string views;
  for (const View view : all_views()) views += (views.empty() ? "" : ", ") + std::string(view_name(view));
  verb->add_option("FILE", a->subject.file, "Head, model or take (.phiz), or a mesh (.obj, .ply, .stl, .glb)")
      ->required();
  verb->add_option("-o,--output", a->output, "Picture (.png) or film (.mp4; what does not move is turned round)")
      ->required();
  verb->add_option("--view", a->views, "View or views: " + views)->delimiter(',');
  verb->add_option("--style", a->style,
                   "clay, skin, wireframe, anatomy, bones, cutaway, muscles, fibres, attachments, contacts or heat")
      ->capture_default_str();
  verb->add_option("--frame", a->frame, "Frame of a take")->check(between(0, 1e6));
  verb->add_option("--frames", a->frames, "Frames FIRST to END - 1 of a take")->type_name("FIRST:END");
  verb->add_option("--size", a->size, "Pixels of the picture, the film or each picture of a sheet")->type_name("WxH");
  verb->add_flag("--sheet", a->sheet, "A sheet of many pictures: frames of a take, views of anything else");
  verb->add_option("--model", a->subject.model, "The head of a take: colours of the skin, tissue in cut-aways")
      ->type_name("HEAD");
  verb->add_option("--quantity", a->subject.quantity,
                   "Heat map of displacement, speed, stretch or penetration (takes), thickness (heads)");
  verb->add_option("--values", a->subject.values, "Heat map of the numbers in a file, one per vertex and line")
      ->type_name("FILE");
  verb->add_option("--range", a->range, "Ends of the heat map's scale")->type_name("LOW:HIGH");
  add_object_options(*verb, a->object);
  verb->add_option("--cut", a->cut, "Plane of a cut-away in the head frame, e.g. x=4 (millimetres) or -z=20")
      ->type_name("AXIS=MM");
  verb->add_flag("--tets", a->subject.view.cut_tets, "Show the tets in a cut-away and the share that muscles fill");
  verb->add_option("--peel", a->peel, "Show muscles, fibres or attachments with skin on the side that this plane keeps")
      ->type_name("AXIS=MM");
  verb->add_option("--muscle", a->subject.view.muscles, "Show these muscles only; without Left or Right: both sides")
      ->delimiter(',')
      ->type_name("NAME");
  verb->add_flag("--muscle-colours", a->subject.view.muscle_colours, "A colour per muscle, with their names");
  verb->add_option("--expression", a->expressions, "Expressions that a head shows")->type_name("NAME=WEIGHT");
  verb->add_flag("--all-expressions", a->all_expressions, "A sheet of all expressions of a head");
  verb->add_option("--fps", a->fps, "Frames per second of a film; the take's own without")->check(between(1, 240));
  verb->add_option("--quality", a->quality, "Rays per pixel")
      ->check(CLI::IsMember({"draft", "normal", "fine"}))
      ->capture_default_str();
  add_report(*verb, a->report);
  verb->footer(
      "Examples:\n"
      "  phiz render head.phiz -o head.png --style skin --view three-quarter --size 1024x1024\n"
      "  phiz render head.phiz -o cut.png --style cutaway --cut x=4 --view side\n"
      "  phiz render head.phiz -o muscles.png --style muscles --peel x=0 --view front --muscle-colours\n"
      "  phiz render take.phiz -o film.mp4 --view front --size 640x640\n"
      "  phiz render take.phiz -o heat.png --sheet --quantity displacement");
  verb->callback([a] { run_render(*a); });
}

}  // namespace phiz
