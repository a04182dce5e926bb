// SPDX-License-Identifier: GPL-3.0-or-later
#include "inputs.h"

#include <fmt/format.h>

#include <utility>

#include "phiz/core/progress.h"
#include "phiz/face/volumetric_blendshapes.h"
#include "phiz/io/container.h"
#include "phiz/io/file_bytes.h"
#include "phiz/io/live_link.h"

namespace phiz {

FaceModel model_of(HeadTemplate head) {
  Progress progress("volumetric blendshapes", static_cast<std::ptrdiff_t>(head.expressions.size()));
  BlendshapeOptions options;
  options.report = [&progress](const std::string&, const SolveStatistics&) { progress.advance(); };
  return build_volumetric_blendshapes(std::move(head), options);
}

FaceModel load_model(const std::string& path) {
  if (kind_of(path) != ContainerKind::head_template) return load_face_model(path);
  return model_of(load_head_template(path));
}

Performance load_any_performance(const std::string& path) {
  if (lower_extension(path) == ".phiz") return load_performance(path);
  const LiveLinkRecording recording = read_live_link(path);
  for (const std::string& note : recording.notes) announce(fmt::format("{}: {}", path, note));
  return recording.performance;
}

}  // namespace phiz
