// SPDX-License-Identifier: GPL-3.0-or-later
#include "render_subject.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "options.h"
#include "phiz/core/error.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/validate.h"
#include "phiz/io/container.h"
#include "phiz/io/file_bytes.h"
#include "phiz/io/mesh_file.h"
#include "phiz/io/take_file.h"
#include "phiz/io/text_scanner.h"
#include "phiz/render/head_quantities.h"
#include "phiz/render/materials.h"
#include "phiz/render/palette.h"

namespace phiz {

namespace {

VectorXd read_values(const std::string& path, Eigen::Index count) {
  const std::string text = read_bytes(path);
  LineScanner lines(text);
  std::vector<double> values;
  while (lines.next()) {
    const std::string_view word = trimmed(lines.line());
    if (word.empty() || word.front() == '#') continue;
    const auto number = parse_number(word);
    if (!number || !std::isfinite(*number))
      reject(fmt::format("{}:{}", path, lines.number()), quoted_word(word) + " is not a finite number",
             "write one number per line, one line per vertex");
    values.push_back(*number);
  }
  if (static_cast<Eigen::Index>(values.size()) != count)
    reject(path, fmt::format("it has {} numbers for {} vertices", values.size(), count),
           "write one number per line, one line per vertex of the skin");
  return Eigen::Map<VectorXd>(values.data(), count);
}

HeatScale scale_of(const SubjectOptions& options, const VectorXd& values, const std::string& quantity,
                   const std::string& unit) {
  HeatScale scale = fit_heat_scale(values, quantity, unit);
  if (options.low < options.high) {
    scale.low = options.low;
    scale.high = options.high;
    scale.map = options.low < 0 && options.high > 0 ? ColourMap::diverging : ColourMap::sequential;
  }
  return scale;
}

[[noreturn]] void refuse_quantity(const SubjectOptions& options, const std::string& known) {
  misuse(options.quantity.empty()
             ? fmt::format("a heat map of {} needs --quantity: {}", options.file, known)
             : fmt::format("a heat map of '{}' cannot be made of {}; use {}", options.quantity, options.file, known));
}

Subject open_mesh(const SubjectOptions& options) {
  const PolygonMesh polygons = read_mesh(options.file);
  std::vector<int> face;
  auto base = std::make_shared<Surface>();
  base->name = options.file;
  base->mesh = triangulate(polygons, &face);
  if (base->mesh.F.rows() == 0) reject(options.file, "it has no faces", "give a mesh with triangles or polygons");
  if (suspect_unit(base->mesh.V).extent <= 0) reject(options.file, "all its vertices are in one place");
  for (const HeadStyle s : {HeadStyle::muscles, HeadStyle::fibres, HeadStyle::attachments, HeadStyle::contacts})
    if (options.view.style == s) misuse(options.file + " is a mesh and has no muscles, attachments or contact regions");
  if (const std::string defect = unit_defect(base->mesh.V); options.view.style == HeadStyle::cutaway && !defect.empty())
    reject(options.file, defect);  // the plane of the cut is in millimetres
  Subject subject;
  const HeadStyle style = options.view.style;
  base->material = style == HeadStyle::skin    ? skin_material()
                   : style == HeadStyle::bones ? bone_material()
                                               : clay_material();
  if (style == HeadStyle::wireframe) {
    base->wireframe.shown = true;
    for (Eigen::Index f = 0; f < base->mesh.F.rows(); ++f) {
      // An edge of a triangle is drawn when it is an edge of the polygon.
      const std::vector<int>& polygon = polygons.faces[face[f]];
      unsigned edges = 0;
      for (int k = 0; k < 3; ++k)
        for (std::size_t c = 0; c < polygon.size(); ++c)
          if (polygon[c] == base->mesh.F(f, k) && polygon[(c + 1) % polygon.size()] == base->mesh.F(f, (k + 1) % 3))
            edges |= 1U << k;
      base->wireframe.edges.push_back(static_cast<std::uint8_t>(edges));
    }
  }
  if (style == HeadStyle::heat) {
    if (options.values.empty()) refuse_quantity(options, "--values FILE");
    const VectorXd values = read_values(options.values, base->mesh.V.rows());
    subject.scale = scale_of(options, values, options.quantity.empty() ? "value" : options.quantity, "");
    subject.has_legend = true;
    paint_heat(*base, values, subject.scale);
  }
  subject.points = base->mesh.V;
  subject.scene = [base, style, plane = options.view.plane](int, bool) {
    Scene scene;
    if (style == HeadStyle::cutaway) {
      scene.surfaces.push_back(cut_surface(*base, plane));
      Surface face_of_cut = cap(*base, plane);
      face_of_cut.material = section_material();
      face_of_cut.material.albedo = tissue_colour::flesh;
      if (face_of_cut.mesh.F.rows() > 0) scene.surfaces.push_back(std::move(face_of_cut));
    } else {
      scene.surfaces.push_back(*base);
    }
    return scene;
  };
  subject.camera = [points = base->mesh.V](View view, int width, int height) {
    return frame_view(view, points, guess_face_points(points), width, height);
  };
  return subject;
}

Subject open_head(const SubjectOptions& options, const std::shared_ptr<const HeadTemplate>& head) {
  Subject subject;
  subject.name = head->name;
  auto view = std::make_shared<HeadViewOptions>(options.view);
  if (view->style == HeadStyle::heat) {
    if (!options.values.empty()) {
      view->values = read_values(options.values, head->skin.V.rows());
      view->scale = scale_of(options, view->values, options.quantity.empty() ? "value" : options.quantity, "");
    } else if (options.quantity == "thickness") {
      view->values = flesh_thickness(*head);
      view->scale = scale_of(options, view->values, "flesh thickness", "mm");
    } else {
      refuse_quantity(options, "thickness, or --values FILE");
    }
    subject.scale = view->scale;
    subject.has_legend = true;
  }
  subject.names = head_legend(*head, *view);
  for (const Expression& e : head->expressions) subject.expressions.push_back(e.name);
  subject.points = head->skin.V;
  subject.scene = [head, view](int, bool) { return head_scene(*head, *view); };
  subject.camera = [head, view](View v, int width, int height) { return head_camera(*head, *view, v, width, height); };
  subject.express = [view](const std::map<std::string, double>& weights) { view->expressions = weights; };
  return subject;
}

/// Values of a heat map of a frame of a take.
VectorXd take_values(const SubjectOptions& options, const TakeReader& reader, int index, const VectorXd& thickness) {
  const TakeFrame frame = reader.frame(index);
  if (options.quantity == "displacement") return skin_displacement(reader.head(), frame);
  if (options.quantity == "stretch") return skin_stretch(reader.head(), frame);
  if (options.quantity == "penetration") return teeth_penetration(reader.head(), frame);
  if (options.quantity == "speed") return skin_speed(reader.frame(std::max(index - 1, 0)), frame);
  return thickness;
}

Surface object_surface(const SimulateObject& object, const TakeFrame& frame, bool still_head) {
  Surface surface;
  surface.name = "object";
  surface.mesh = object.mesh;
  const Eigen::Isometry3d place = object.path.at(frame.time);
  const Eigen::Isometry3d seen = object.on_head ? place : frame.head.inverse() * place;
  surface.transform = still_head ? seen : frame.head * seen;
  surface.material = clay_material();
  surface.material.albedo = Vector3d(0.16, 0.24, 0.34);
  surface.flat = true;
  return surface;
}

Subject open_take(const SubjectOptions& options) {
  auto reader = std::make_shared<TakeReader>(options.file);
  if (reader->frames() == 0) reject(options.file, "the take has no frames", "animate again");
  std::shared_ptr<HeadTemplate> head;
  if (!options.model.empty())
    head = std::make_shared<HeadTemplate>(kind_of(options.model) == ContainerKind::face_model
                                              ? load_face_model(options.model).head
                                              : load_head_template(options.model));
  Subject subject;
  subject.name = reader->head().model;
  if (head != nullptr) subject.names = head_legend(*head, options.view);
  subject.frames = reader->frames();
  subject.frame_rate = reader->head().frame_rate;
  subject.points = reader->head().skin.V;

  VectorXd fixed;
  if (options.view.style == HeadStyle::heat) {
    const Eigen::Index n = subject.points.rows();
    std::string unit = "mm", quantity = options.quantity;
    if (!options.values.empty()) {
      fixed = read_values(options.values, n);
      unit.clear();
      if (quantity.empty()) quantity = "value";
    } else if (quantity == "thickness" && head != nullptr) {
      fixed = flesh_thickness(*head);
    } else if (quantity == "speed") {
      unit = "mm/s";
    } else if (quantity == "stretch") {
      unit = "%";
    } else if (quantity != "displacement" && quantity != "penetration") {
      refuse_quantity(options, "displacement, speed, stretch, penetration, thickness (with --model), or --values FILE");
    }
    // One scale for the whole take, from frames spread over it.
    const int looks = fixed.size() > 0 ? 1 : std::min(subject.frames, 24);
    VectorXd seen(n * looks);
    for (int i = 0; i < looks; ++i)
      seen.segment(i * n, n) =
          fixed.size() > 0 ? fixed : take_values(options, *reader, (2 * i + 1) * subject.frames / (2 * looks), fixed);
    subject.scale = scale_of(options, seen, quantity, unit);
    subject.has_legend = true;
  }
  subject.scene = [reader, head, options, fixed, scale = subject.scale](int index, bool close_up) {
    HeadViewOptions view = options.view;
    view.still_head = close_up;
    if (view.style == HeadStyle::heat) {
      view.values = fixed.size() > 0 ? fixed : take_values(options, *reader, index, fixed);
      view.scale = scale;
    }
    const TakeFrame frame = reader->frame(index);
    Scene scene = head_scene(reader->head(), frame, view, head.get());
    if (options.object) scene.surfaces.push_back(object_surface(*options.object, frame, close_up));
    return scene;
  };
  auto sampled = std::make_shared<Take>(reader->head());
  for (int i = 0; i < subject.frames; i += std::max(1, subject.frames / 30))
    sampled->frames.push_back(reader->frame(i));
  subject.camera = [sampled](View v, int width, int height) { return take_camera(*sampled, v, width, height); };
  return subject;
}

}  // namespace

Subject open_subject(const SubjectOptions& options) {
  Subject subject;
  if (options.object && (lower_extension(options.file) != ".phiz" || kind_of(options.file) != ContainerKind::take))
    misuse("--object is shown beside a take; " + options.file + " is none");
  if (lower_extension(options.file) != ".phiz") {
    subject = open_mesh(options);
  } else {
    switch (kind_of(options.file)) {
      case ContainerKind::head_template:
        subject = open_head(options, std::make_shared<HeadTemplate>(load_head_template(options.file)));
        break;
      case ContainerKind::face_model:
        subject = open_head(options, std::make_shared<HeadTemplate>(load_face_model(options.file).head));
        break;
      case ContainerKind::take:
        subject = open_take(options);
        break;
      default:
        reject(options.file, "it holds a performance, which cannot be seen",
               "animate a head with it first: phiz animate HEAD.phiz FILE -o take.phiz");
    }
  }
  if (subject.name.empty()) subject.name = options.file;
  if (!options.view.expressions.empty()) {
    if (!subject.express) misuse(options.file + " has no expressions of its own; --expression needs a head");
    subject.express(options.view.expressions);
  }
  return subject;
}

}  // namespace phiz
