// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/io/inspect.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "phiz/core/error.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/topology.h"
#include "phiz/io/container.h"
#include "phiz/io/file_bytes.h"
#include "phiz/io/gltf.h"
#include "phiz/io/inspect_nouns.h"
#include "phiz/io/live_link.h"
#include "phiz/io/mesh_file.h"
#include "phiz/io/png.h"
#include "phiz/io/point_cache.h"

namespace phiz {

using nlohmann::json;

namespace {

json size_of(const MatrixX3d& V) {
  const Eigen::RowVector3d low = V.colwise().minCoeff(), high = V.colwise().maxCoeff();
  const SuspectedUnit unit = suspect_unit(V);
  return {{"min", {low[0], low[1], low[2]}}, {"max", {high[0], high[1], high[2]}}, {"unit", unit.name}};
}

void note_unit(json& description, const MatrixX3d& V) {
  const std::string defect = unit_defect(V);
  if (!defect.empty()) description["problems"] = {defect};
}

json describe_mesh(const std::string& path) {
  const PolygonMesh mesh = read_mesh(path);
  std::size_t triangles = 0, quads = 0;
  for (const auto& face : mesh.faces) {
    triangles += face.size() == 3 ? 1 : 0;
    quads += face.size() == 4 ? 1 : 0;
  }
  json result = {{"kind", "mesh"},
                 {"vertices", mesh.V.rows()},
                 {"faces", mesh.faces.size()},
                 {"triangles", triangles},
                 {"quads", quads},
                 {"texture_coordinates", mesh.UV.rows()},
                 {"bounds", size_of(mesh.V)}};
  note_unit(result, mesh.V);
  if (!mesh.groups.empty()) result["groups"] = mesh.groups;
  if (mesh.faces.empty()) return result;
  const TriangleMesh surface = triangulate(mesh);
  result["closed"] = is_closed(surface.F);
  result["manifold"] = is_edge_manifold(surface.F) && is_vertex_manifold(surface.F);
  result["oriented"] = is_oriented(surface.F);
  result["pieces"] = triangle_components(surface.F).maxCoeff() + 1;
  result["area"] = triangle_areas(surface.V, surface.F).sum();
  return result;
}

json describe_scene(const std::string& path) {
  const GltfScene scene = read_gltf(path);
  json result = {{"kind", "scene"}, {"materials", scene.materials.size()}};
  Eigen::Index vertices = 0, triangles = 0;
  json nodes = json::array();
  for (const GltfMesh& mesh : scene.meshes) {
    for (const GltfPrimitive& p : mesh.primitives) vertices += p.positions.rows(), triangles += p.triangles.rows();
  }
  for (const GltfNode& node : scene.nodes) {
    json item = {{"name", node.name}};
    if (node.mesh >= 0) {
      const GltfMesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
      item["mesh"] = mesh.name;
      item["morph_targets"] = mesh.primitives.empty() ? 0 : mesh.primitives[0].targets.size();
    }
    nodes.push_back(item);
  }
  result["vertices"] = vertices;
  result["triangles"] = triangles;
  result["nodes"] = nodes;
  json animations = json::array();
  for (const GltfAnimation& animation : scene.animations) {
    std::size_t frames = 0;
    float duration = 0;
    for (const GltfChannel& channel : animation.channels) {
      frames = std::max(frames, channel.times.size());
      duration = std::max(duration, channel.times.back());
    }
    animations.push_back({{"name", animation.name},
                          {"channels", animation.channels.size()},
                          {"frames", frames},
                          {"duration_s", duration}});
  }
  result["animations"] = animations;
  const MatrixX3d points = flattened(scene).V;
  if (points.rows() == 0) return result;
  result["bounds"] = size_of(points);
  note_unit(result, points);
  return result;
}

json describe_image(const std::string& path) {
  const DeepImage image = read_deep_png(path);
  return {{"kind", "image"}, {"width", image.width}, {"height", image.height}, {"channels", image.channels}};
}

json describe_cache(const PointCache& cache, bool knows_time) {
  json result = {{"kind", "point cache"}, {"frames", cache.frames.size()}, {"points", cache.frames[0].rows()}};
  if (knows_time) result["frame_rate"] = cache.frame_rate;
  return result;
}

json describe_recording(const std::string& path) {
  const LiveLinkRecording recording = read_live_link(path);
  json result = describe(recording.performance);
  result["kind"] = "recording";
  result["notes"] = recording.notes;
  return result;
}

/// One line per member, nested ones indented; lists of numbers on one line.
void append_lines(std::string& text, const json& value, const std::string& name, int depth) {
  const std::string indent(static_cast<std::size_t>(2 * depth), ' ');
  const auto flat = [](const json& v) {
    if (v.is_string()) return v.get<std::string>();
    if (v.is_number_float()) return fmt::format("{:.6g}", v.get<double>());
    return v.dump(-1, ' ', false, json::error_handler_t::replace);
  };
  if (value.is_object()) {
    text += fmt::format("{}{}\n", indent, name);
    for (const auto& [key, member] : value.items()) append_lines(text, member, key, depth + 1);
  } else if (value.is_array() && !value.empty() && value[0].is_object()) {
    text += fmt::format("{}{}\n", indent, name);
    for (const json& item : value) {
      std::string line;
      for (const auto& [key, member] : item.items()) {
        line += fmt::format("{}{} {}", line.empty() ? "" : ", ", key, flat(member));
      }
      text += fmt::format("{}  {}\n", indent, line);
    }
  } else if (value.is_array()) {
    std::string line;
    for (const json& item : value) line += (line.empty() ? "" : ", ") + flat(item);
    text += fmt::format("{}{}: {}\n", indent, name, line.empty() ? "none" : line);
  } else {
    text += fmt::format("{}{}: {}\n", indent, name, flat(value));
  }
}

}  // namespace

json inspect(const std::string& path) {
  const std::string extension = lower_extension(path);
  json result;
  if (extension == ".phiz" || extension == ".part") {
    result = describe_container(path);
  } else if (extension == ".obj" || extension == ".ply" || extension == ".stl") {
    result = describe_mesh(path);
  } else if (extension == ".glb" || extension == ".gltf") {
    result = describe_scene(path);
  } else if (extension == ".csv") {
    result = describe_recording(path);
  } else if (extension == ".png") {
    result = describe_image(path);
  } else if (extension == ".pc2") {
    result = describe_cache(read_pc2(path), false);
  } else if (extension == ".mdd") {
    result = describe_cache(read_mdd(path), true);
  } else {
    if (!std::filesystem::exists(path)) reject(path, "the file does not exist", "check the path");
    reject(path, fmt::format("nothing reads files with the extension '{}'", extension),
           "use .phiz, .obj, .ply, .stl, .glb, .gltf, .csv, .png, .pc2 or .mdd");
  }
  result["file"] = path;
  result["format"] = extension.substr(1);
  std::error_code code;
  result["bytes"] = std::filesystem::file_size(path, code);
  return result;
}

std::string readable(const json& description) {
  std::string text;
  const std::string file = description.value("file", "");
  text += fmt::format("{}: {}\n", file, description.value("kind", ""));
  for (const auto& [name, member] : description.items()) {
    if (name != "file" && name != "kind") append_lines(text, member, name, 1);
  }
  return text;
}

}  // namespace phiz
