// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "phiz/core/error.h"
#include "phiz/io/base64.h"
#include "phiz/io/byte_order.h"
#include "phiz/io/file_bytes.h"
#include "phiz/io/gltf.h"
#include "phiz/io/gltf_format.h"
#include "phiz/io/output_file.h"

namespace phiz {

namespace {

using nlohmann::json;

/// Number of vertices up to which 16-bit indices do (65535 restarts primitives).
constexpr Eigen::Index most_short_vertices = 65535;

class GltfWriter {
 public:
  explicit GltfWriter(const GltfScene& scene) : scene_(scene) {}

  json document(std::string& buffer) {
    json doc;
    doc["asset"] = {{"version", "2.0"}, {"generator", "Phiz"}};
    if (!scene_.notes_json.empty()) doc["asset"]["extras"] = json::parse(scene_.notes_json);
    doc["scene"] = 0;
    doc["scenes"] = json::array({json{{"nodes", scene_.roots}}});
    for (const GltfMaterial& material : scene_.materials) doc["materials"].push_back(write(material));
    for (const GltfMesh& mesh : scene_.meshes) doc["meshes"].push_back(write(mesh));
    for (const GltfNode& node : scene_.nodes) doc["nodes"].push_back(write(node));
    for (const GltfAnimation& animation : scene_.animations) doc["animations"].push_back(write(animation));
    for (const auto& [name, list] : {std::pair{"images", &images_}, std::pair{"textures", &textures_},
                                     std::pair{"accessors", &accessors_}, std::pair{"bufferViews", &views_}}) {
      if (!list->empty()) doc[name] = *list;
    }
    if (!textures_.empty()) {
      doc["samplers"] = json::array({json{{"magFilter", gltf::linear}, {"minFilter", gltf::linear_mipmap_linear}}});
    }
    buffer = std::move(bytes_);
    return doc;
  }

 private:
  json write(const GltfMaterial& material) {
    const Eigen::Vector4d& c = material.base_colour;
    json surface = {{"baseColorFactor", {c[0], c[1], c[2], c[3]}},
                    {"metallicFactor", material.metallic},
                    {"roughnessFactor", material.roughness}};
    if (!material.base_colour_png.empty()) {
      images_.push_back({{"bufferView", add_view(material.base_colour_png, 0)}, {"mimeType", "image/png"}});
      textures_.push_back({{"sampler", 0}, {"source", images_.size() - 1}});
      surface["baseColorTexture"] = {{"index", textures_.size() - 1}};
    }
    json result = {{"name", material.name}, {"pbrMetallicRoughness", surface}};
    if (material.double_sided) result["doubleSided"] = true;
    if (c[3] < 1) result["alphaMode"] = "BLEND";
    return result;
  }

  json write(const GltfMesh& mesh) {
    if (mesh.primitives.empty()) fail("the mesh '" + mesh.name + "' has no triangles");
    json result = {{"name", mesh.name}};
    const std::size_t targets = mesh.primitives[0].targets.size();
    for (const GltfPrimitive& primitive : mesh.primitives) {
      if (primitive.targets.size() != targets) fail("the primitives of '" + mesh.name + "' differ in their targets");
      result["primitives"].push_back(write(primitive, mesh.name));
    }
    if (targets > 0) {
      result["weights"] = std::vector<double>(targets, 0.0);
      if (!mesh.target_names.empty()) result["extras"] = {{"targetNames", mesh.target_names}};
    }
    return result;
  }

  json write(const GltfPrimitive& p, const std::string& name) {
    const auto n = p.positions.rows();
    const auto fits = [n](Eigen::Index rows) { return rows == 0 || rows == n; };
    if (n == 0 || p.triangles.rows() == 0) fail("a primitive of '" + name + "' is empty");
    if (!fits(p.normals.rows()) || !fits(p.texels.rows()) || !fits(p.colours.rows())) {
      fail("the attributes of '" + name + "' differ in length");
    }
    if (p.triangles.minCoeff() < 0 || p.triangles.maxCoeff() >= n) fail("a triangle of '" + name + "' is out of range");
    json attributes = {{"POSITION", add_vectors(p.positions, "VEC3", true)}};
    if (p.normals.rows() > 0) attributes["NORMAL"] = add_vectors(p.normals, "VEC3", false);
    if (p.texels.rows() > 0) attributes["TEXCOORD_0"] = add_vectors(p.texels, "VEC2", false);
    if (p.colours.rows() > 0) attributes["COLOR_0"] = add_vectors(p.colours, "VEC4", false);
    json result = {{"attributes", attributes}, {"indices", add_indices(p.triangles, n)}, {"mode", gltf::triangles}};
    if (p.material >= 0) result["material"] = p.material;
    for (const GltfTarget& target : p.targets) {
      if (target.positions.rows() != n || !fits(target.normals.rows())) {
        fail("a morph target of '" + name + "' has another number of vertices");
      }
      json differences = {{"POSITION", add_vectors(target.positions, "VEC3", true)}};
      if (target.normals.rows() > 0) differences["NORMAL"] = add_vectors(target.normals, "VEC3", false);
      result["targets"].push_back(differences);
    }
    return result;
  }

  json write(const GltfNode& node) const {
    json result = {{"name", node.name}};
    const Eigen::Quaterniond q = node.rotation.normalized();
    if (!node.translation.isZero(0)) {
      result["translation"] = {node.translation.x(), node.translation.y(), node.translation.z()};
    }
    if (!q.isApprox(Eigen::Quaterniond::Identity(), 1e-12)) result["rotation"] = {q.x(), q.y(), q.z(), q.w()};
    if (node.scale != Vector3d::Ones()) result["scale"] = {node.scale.x(), node.scale.y(), node.scale.z()};
    if (node.mesh >= 0) result["mesh"] = node.mesh;
    if (!node.children.empty()) result["children"] = node.children;
    return result;
  }

  json write(const GltfAnimation& animation) {
    json result = {{"name", animation.name}, {"channels", json::array()}, {"samplers", json::array()}};
    static constexpr std::array paths = {"translation", "rotation", "scale", "weights"};
    std::vector<float> times;  // channels in a row often share theirs
    std::size_t times_accessor = 0;
    for (const GltfChannel& channel : animation.channels) {
      if (channel.values.rows() != static_cast<Eigen::Index>(channel.times.size()) || channel.times.empty()) {
        fail("an animation channel of '" + animation.name + "' has another number of values than of times");
      }
      if (times != channel.times) {
        times = channel.times;
        times_accessor = add_scalars(times.data(), static_cast<Eigen::Index>(times.size()), true);
      }
      const std::size_t values = channel.path == GltfPath::weights
                                     ? add_scalars(channel.values.data(), channel.values.size(), false)
                                     : add_rows(channel.values.data(), channel.values.rows(),
                                                channel.path == GltfPath::rotation ? "VEC4" : "VEC3");
      result["samplers"].push_back(
          {{"input", times_accessor}, {"output", values}, {"interpolation", channel.step ? "STEP" : "LINEAR"}});
      result["channels"].push_back(
          {{"sampler", result["samplers"].size() - 1},
           {"target", {{"node", channel.node}, {"path", paths[static_cast<std::size_t>(channel.path)]}}}});
    }
    return result;
  }

  /// Puts bytes at the end of the buffer, aligned to 4; target: what a graphics card uses them for, or 0.
  std::size_t add_view(std::string_view content, int target) {
    bytes_.resize((bytes_.size() + 3) / 4 * 4, '\0');
    json view = {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", content.size()}};
    if (target != 0) view["target"] = target;
    bytes_.append(content);
    views_.push_back(view);
    return views_.size() - 1;
  }

  std::size_t add_accessor(std::size_t view, int component, Eigen::Index count, const char* type) {
    accessors_.push_back({{"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}});
    return accessors_.size() - 1;
  }

  static std::string_view raw(const float* values, Eigen::Index count) {
    return {reinterpret_cast<const char*>(values), static_cast<std::size_t>(count) * sizeof(float)};
  }

  template <class Rows>
  std::size_t add_vectors(const Rows& rows, const char* type, bool bounds) {
    const std::size_t view = add_view(raw(rows.data(), rows.size()), gltf::array_buffer);
    const std::size_t accessor = add_accessor(view, gltf::float32, rows.rows(), type);
    if (bounds) {
      for (int k = 0; k < rows.cols(); ++k) {
        accessors_[accessor]["min"].push_back(rows.col(k).minCoeff());
        accessors_[accessor]["max"].push_back(rows.col(k).maxCoeff());
      }
    }
    return accessor;
  }

  std::size_t add_rows(const float* values, Eigen::Index count, const char* type) {
    const Eigen::Index columns = std::string_view(type) == "VEC4" ? 4 : 3;
    return add_accessor(add_view(raw(values, count * columns), 0), gltf::float32, count, type);
  }

  std::size_t add_scalars(const float* values, Eigen::Index count, bool bounds) {
    const std::size_t accessor = add_accessor(add_view(raw(values, count), 0), gltf::float32, count, "SCALAR");
    if (bounds) {
      const Eigen::Map<const Eigen::VectorXf> all(values, count);
      accessors_[accessor]["min"] = {all.minCoeff()};
      accessors_[accessor]["max"] = {all.maxCoeff()};
    }
    return accessor;
  }

  std::size_t add_indices(const GltfTriangles& triangles, Eigen::Index vertices) {
    const bool is_short = vertices <= most_short_vertices;
    std::string content;
    for (Eigen::Index i = 0; i < triangles.size(); ++i) {
      if (is_short) {
        append_number(content, static_cast<std::uint16_t>(triangles.data()[i]));
      } else {
        append_number(content, static_cast<std::uint32_t>(triangles.data()[i]));
      }
    }
    return add_accessor(add_view(content, gltf::element_array_buffer), is_short ? gltf::uint16 : gltf::uint32,
                        triangles.size(), "SCALAR");
  }

  const GltfScene& scene_;
  std::string bytes_;
  json accessors_ = json::array(), views_ = json::array(), images_ = json::array(), textures_ = json::array();
};

}  // namespace

void write_gltf(const std::string& path, const GltfScene& scene) {
  std::string buffer;
  nlohmann::json doc = GltfWriter(scene).document(buffer);
  OutputFile file(path);
  if (lower_extension(path) == ".gltf") {
    if (!buffer.empty()) {
      doc["buffers"] = nlohmann::json::array({nlohmann::json{
          {"byteLength", buffer.size()}, {"uri", "data:application/octet-stream;base64," + to_base64(buffer)}}});
    }
    file.write(doc.dump(1, ' ', false, nlohmann::json::error_handler_t::replace));
    file.commit();
    return;
  }
  buffer.resize((buffer.size() + 3) / 4 * 4, '\0');
  if (!buffer.empty()) {
    doc["buffers"] = nlohmann::json::array({nlohmann::json{{"byteLength", buffer.size()}}});
  }
  std::string text = doc.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::size_t total = 12 + 8 + text.size() + (buffer.empty() ? 0 : 8 + buffer.size());
  if (total > 0xFFFFFFFFu) fail("cannot write " + path + ": a GLB file holds at most 4 GiB", "export fewer frames");
  std::string header;
  for (const std::size_t word :
       {std::size_t{gltf::glb_magic}, std::size_t{2}, total, text.size(), std::size_t{gltf::json_chunk}}) {
    append_number(header, static_cast<std::uint32_t>(word));
  }
  file.write(header);
  file.write(text);
  if (!buffer.empty()) {
    header.clear();
    append_number(header, static_cast<std::uint32_t>(buffer.size()));
    append_number(header, gltf::binary_chunk);
    file.write(header);
    file.write(buffer);
  }
  file.commit();
}

}  // namespace phiz
