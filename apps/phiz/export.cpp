// SPDX-License-Identifier: GPL-3.0-or-later
// phiz export: takes and heads for other programs.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "options.h"
#include "phiz/core/error.h"
#include "phiz/io/container.h"
#include "phiz/io/file_bytes.h"
#include "phiz/io/mesh_file.h"
#include "phiz/io/take_export.h"
#include "phiz/io/take_file.h"
#include "phiz/io/take_gltf.h"
#include "report.h"
#include "verbs.h"

namespace phiz {

namespace {

struct ExportArguments {
  std::string input;
  std::string output;
  double tolerance_mm = 0.05;
  Report report;
};

void export_take(const ExportArguments& arguments, const Take& take) {
  const std::string extension = lower_extension(arguments.output);
  nlohmann::json report{{"file", arguments.output}, {"frames", take.frames.size()}};
  std::string text = fmt::format("{}: {} frames", arguments.output, take.frames.size());
  if (extension == ".glb" || extension == ".gltf") {
    TakeGltfOptions options;
    options.tolerance = 1e-3 * arguments.tolerance_mm;
    const TakeGltfReport made = export_take_gltf(take, arguments.output, options);
    report["vertices"] = made.vertices;
    report["shapes"] = made.shapes;
    report["error_mm_max"] = 1e3 * made.max_error;
    report["error_mm_rms"] = 1e3 * made.rms_error;
    text += fmt::format(", {} vertices, {} morph targets, at most {:.3f} mm from the take", made.vertices, made.shapes,
                        1e3 * made.max_error);
  } else if (extension == ".obj") {
    report["files"] = export_take_obj_sequence(take, arguments.output);
  } else if (extension == ".pc2" || extension == ".mdd") {
    export_take_point_cache(take, arguments.output);
  } else {
    misuse("cannot export a take to '" + extension + "'; known: .glb, .gltf, .obj, .pc2, .mdd");
  }
  arguments.report.print(text + "\n");
  arguments.report.write(report);
}

void export_head(const ExportArguments& arguments, const HeadTemplate& head) {
  const std::string extension = lower_extension(arguments.output);
  if (extension == ".glb" || extension == ".gltf") {
    export_take(arguments, rest_take(head));
    return;
  }
  write_mesh(arguments.output, head.skin);
  arguments.report.print(fmt::format("{}: skin of {}, {} vertices\n", arguments.output, head.name, head.skin.V.rows()));
  arguments.report.write({{"file", arguments.output}, {"vertices", head.skin.V.rows()}});
}

void export_file(const ExportArguments& arguments) {
  switch (kind_of(arguments.input)) {
    case ContainerKind::head_template:
      return export_head(arguments, load_head_template(arguments.input));
    case ContainerKind::face_model:
      return export_head(arguments, load_face_model(arguments.input).head);
    case ContainerKind::take:
      return export_take(arguments, load_take(arguments.input));
    case ContainerKind::performance:
      reject(arguments.input, "holds a performance, which has no surface", "animate a head with it first");
  }
}

}  // namespace

void add_export(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("export", "Write a take or a head for other programs");
  auto arguments = std::make_shared<ExportArguments>();
  verb->add_option("FILE", arguments->input, "A take, a head or a face model, a .phiz file")->required();
  verb->add_option(
          "-o,--output", arguments->output,
          "x.glb or x.gltf: animated scene with skin, eyes, teeth and bones as nodes; x.obj: one file a frame; x.pc2, "
          "x.mdd: point cache of the skin. A head also to x.ply and x.stl")
      ->required()
      ->type_name("FILE");
  verb->add_option("--tolerance", arguments->tolerance_mm,
                   "glTF: largest distance of the skin from the take, millimetres")
      ->check(between(1e-4, 10))
      ->capture_default_str();
  add_report(*verb, arguments->report);
  verb->footer("Example:\n  phiz export take.phiz -o take.glb");
  verb->callback([arguments] { export_file(*arguments); });
}

}  // namespace phiz
