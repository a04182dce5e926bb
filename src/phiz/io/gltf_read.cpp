// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "phiz/core/error.h"
#include "phiz/io/file_bytes.h"
#include "phiz/io/gltf.h"
#include "phiz/io/gltf_document.h"
#include "phiz/io/gltf_format.h"

namespace phiz {

using nlohmann::json;

namespace {

constexpr Eigen::Index most_vertices = 100'000'000;  // of a flattened scene

class GltfReader {
 public:
  GltfReader(std::string_view bytes, const std::string& where, const std::string& folder)
      : doc_(bytes, where, folder) {}

  GltfScene read() {
    for (const json& m : doc_.list("materials")) scene_.materials.push_back(material(m));
    for (const json& m : doc_.list("meshes")) scene_.meshes.push_back(mesh(m));
    for (const json& n : doc_.list("nodes")) scene_.nodes.push_back(node(n));
    require_trees();
    check_scenes();
    for (const json& a : doc_.list("animations")) scene_.animations.push_back(animation(a));
    return std::move(scene_);
  }

 private:
  GltfMaterial material(const json& m) {
    const std::string item = fmt::format("materials[{}]", scene_.materials.size());
    GltfMaterial result;
    result.name = doc_.text(m, "name");
    result.metallic = result.roughness = 1;
    if (m.is_object() && m.contains("pbrMetallicRoughness")) {
      const json& surface = m["pbrMetallicRoughness"];
      const auto colour = doc_.numbers(surface, "baseColorFactor", 4, item);
      if (!colour.empty()) result.base_colour = Eigen::Map<const Eigen::Vector4d>(colour.data());
      result.metallic = doc_.number(surface, "metallicFactor", item).value_or(1);
      result.roughness = doc_.number(surface, "roughnessFactor", item).value_or(1);
    }
    result.double_sided = m.is_object() && m.contains("doubleSided") && m["doubleSided"] == true;
    return result;
  }

  GltfMesh mesh(const json& m) {
    const std::string item = fmt::format("meshes[{}]", scene_.meshes.size());
    GltfMesh result;
    result.name = doc_.text(m, "name");
    if (!m.is_object() || !m.contains("primitives") || !m["primitives"].is_array() || m["primitives"].empty()) {
      reject(doc_.where(item), "has no primitives");
    }
    for (const json& p : m["primitives"]) {
      const auto mode = doc_.integer(p, "mode", item).value_or(gltf::triangles);
      if (mode < 0 || mode > gltf::triangle_fan) reject(doc_.where(item), fmt::format("mode {} is unknown", mode));
      if (mode >= gltf::triangles) result.primitives.push_back(primitive(p, static_cast<int>(mode), item));
    }
    for (const GltfPrimitive& p : result.primitives) {
      if (p.targets.size() != result.primitives[0].targets.size()) {
        reject(doc_.where(item), "its primitives differ in their number of morph targets");
      }
    }
    const json* extras = m.contains("extras") && m["extras"].is_object() ? &m["extras"] : nullptr;
    if (extras != nullptr && extras->contains("targetNames") && (*extras)["targetNames"].is_array()) {
      for (const json& name : (*extras)["targetNames"]) {
        result.target_names.push_back(name.is_string() ? name.get<std::string>() : "");
      }
      const std::size_t targets = result.primitives.empty() ? 0 : result.primitives[0].targets.size();
      if (result.target_names.size() != targets) result.target_names.clear();
    }
    return result;
  }

  template <class Rows>
  void attribute(const json& attributes, const char* name, const std::string& item, Eigen::Index vertices, Rows& rows) {
    const auto accessor = doc_.row(attributes, name, "accessors", item);
    if (!accessor) return;
    GltfDocument::Values values = doc_.values(*accessor, Rows::ColsAtCompileTime);
    if (vertices >= 0 && values.rows() != vertices) {
      reject(doc_.where(item), fmt::format("{} has {} rows, the positions {}", name, values.rows(), vertices));
    }
    rows = std::move(values);
  }

  GltfPrimitive primitive(const json& p, int mode, const std::string& item) {
    GltfPrimitive result;
    if (!p.contains("attributes")) reject(doc_.where(item), "a primitive has no attributes");
    const json& attributes = p["attributes"];
    attribute(attributes, "POSITION", item, -1, result.positions);
    const auto n = result.positions.rows();
    if (n == 0) reject(doc_.where(item), "a primitive has no positions");
    attribute(attributes, "NORMAL", item, n, result.normals);
    attribute(attributes, "TEXCOORD_0", item, n, result.texels);
    read_colours(attributes, item, result);
    result.material = doc_.row(p, "material", "materials", item).value_or(-1);
    result.triangles = triangles(p, mode, n, item);
    if (p.contains("targets")) {
      if (!p["targets"].is_array()) reject(doc_.where(item), "'targets' is not a list");
      for (const json& t : p["targets"]) {
        GltfTarget target;
        attribute(t, "POSITION", item, n, target.positions);
        if (target.positions.rows() == 0) target.positions = GltfVectors::Zero(n, 3);
        attribute(t, "NORMAL", item, n, target.normals);
        result.targets.push_back(std::move(target));
      }
    }
    return result;
  }

  /// Colours may lack alpha.
  void read_colours(const json& attributes, const std::string& item, GltfPrimitive& result) {
    const auto accessor = doc_.row(attributes, "COLOR_0", "accessors", item);
    if (!accessor) return;
    const GltfDocument::Values values = doc_.values(*accessor, 0);
    if (values.rows() != result.positions.rows() || values.cols() < 3) {
      reject(doc_.where(item), "COLOR_0 does not fit the positions");
    }
    result.colours = GltfColours::Ones(values.rows(), 4);
    result.colours.leftCols(values.cols()) = values;
  }

  GltfTriangles triangles(const json& p, int mode, Eigen::Index vertices, const std::string& item) {
    std::vector<std::uint32_t> corners;
    const auto accessor = doc_.row(p, "indices", "accessors", item);
    if (accessor) {
      corners = doc_.indices(*accessor);
    } else {
      for (Eigen::Index i = 0; i < vertices; ++i) corners.push_back(static_cast<std::uint32_t>(i));
    }
    for (const std::uint32_t c : corners) {
      if (c >= static_cast<std::uint64_t>(vertices)) {
        reject(doc_.where(item), fmt::format("index {} is out of range, there are {} vertices", c, vertices));
      }
    }
    if (mode == gltf::triangles && corners.size() % 3 != 0) {
      reject(doc_.where(item), fmt::format("{} indices are not a number of triangles", corners.size()));
    }
    const std::size_t count =
        mode == gltf::triangles ? corners.size() / 3 : corners.size() - std::min<std::size_t>(corners.size(), 2);
    GltfTriangles result(static_cast<Eigen::Index>(count), 3);
    for (std::size_t t = 0; t < count; ++t) {
      std::size_t a = 3 * t, b = a + 1, c = a + 2;
      if (mode == gltf::triangle_fan) a = 0, b = t + 1, c = t + 2;
      if (mode == gltf::triangle_strip) a = t, b = t + 1 + t % 2, c = t + 2 - t % 2;
      result.row(static_cast<Eigen::Index>(t)) << static_cast<int>(corners[a]), static_cast<int>(corners[b]),
          static_cast<int>(corners[c]);
    }
    return result;
  }

  GltfNode node(const json& n) {
    const std::string item = fmt::format("nodes[{}]", scene_.nodes.size());
    GltfNode result;
    result.name = doc_.text(n, "name");
    const auto matrix = doc_.numbers(n, "matrix", 16, item);
    const auto translation = doc_.numbers(n, "translation", 3, item);
    const auto rotation = doc_.numbers(n, "rotation", 4, item);
    const auto scale = doc_.numbers(n, "scale", 3, item);
    if (!matrix.empty()) {
      decompose(Eigen::Map<const Eigen::Matrix4d>(matrix.data()), result);
    }
    if (!translation.empty()) result.translation = Eigen::Map<const Vector3d>(translation.data());
    if (!scale.empty()) result.scale = Eigen::Map<const Vector3d>(scale.data());
    if (!rotation.empty()) {
      result.rotation = Eigen::Quaterniond(rotation[3], rotation[0], rotation[1], rotation[2]);
      if (std::abs(result.rotation.norm() - 1) > 0.01)
        reject(doc_.where(item), "the rotation is not a unit quaternion");
      result.rotation.normalize();
    }
    result.mesh = doc_.row(n, "mesh", "meshes", item).value_or(-1);
    result.children = node_rows(n, "children", item);
    return result;
  }

  /// A list of nodes, which may be absent.
  std::vector<int> node_rows(const json& object, const char* name, const std::string& item) const {
    std::vector<int> rows;
    if (!object.is_object()) reject(doc_.where(item), "is not an object");
    if (!object.contains(name)) return rows;
    if (!object[name].is_array()) reject(doc_.where(item), fmt::format("'{}' is not a list", name));
    const auto count = static_cast<double>(doc_.list("nodes").size());
    for (const json& entry : object[name]) {
      const double row = entry.is_number() ? entry.get<double>() : -1;
      if (!(row >= 0 && row < count)) reject(doc_.where(item), fmt::format("an entry of '{}' is not a node", name));
      rows.push_back(static_cast<int>(row));
    }
    return rows;
  }

  /// Scenes are not kept, since every node is read; but what they say must make sense.
  void check_scenes() const {
    const json& scenes = doc_.list("scenes");
    for (std::size_t i = 0; i < scenes.size(); ++i) node_rows(scenes[i], "nodes", fmt::format("scenes[{}]", i));
    doc_.row(doc_.root(), "scene", "scenes", "scene");
  }

  static void decompose(const Eigen::Matrix4d& m, GltfNode& node) {
    node.translation = m.topRightCorner<3, 1>();
    Matrix3d linear = m.topLeftCorner<3, 3>();
    node.scale = linear.colwise().norm().transpose();
    if (linear.determinant() < 0) node.scale.x() = -node.scale.x();
    for (int k = 0; k < 3; ++k) {
      if (node.scale[k] != 0) linear.col(k) /= node.scale[k];
    }
    const Eigen::Quaterniond q(linear);
    node.rotation = q.coeffs().allFinite() && q.norm() > 1e-6 ? q.normalized() : Eigen::Quaterniond::Identity();
  }

  /// Every node has at most one parent and no node is its own ancestor.
  void require_trees() {
    std::vector<int> parents(scene_.nodes.size(), -1);
    for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
      for (const int child : scene_.nodes[i].children) {
        int& parent = parents[static_cast<std::size_t>(child)];
        if (parent >= 0) reject(doc_.where(fmt::format("nodes[{}]", child)), "has two parents");
        parent = static_cast<int>(i);
      }
    }
    for (std::size_t i = 0; i < parents.size(); ++i) {
      if (parents[i] < 0) scene_.roots.push_back(static_cast<int>(i));
    }
    // With one parent each, a node that no root reaches lies on or below a cycle.
    std::size_t reached = 0;
    std::vector<int> waiting = scene_.roots;
    while (!waiting.empty()) {
      const auto i = static_cast<std::size_t>(waiting.back());
      waiting.pop_back();
      ++reached;
      waiting.insert(waiting.end(), scene_.nodes[i].children.begin(), scene_.nodes[i].children.end());
    }
    if (reached != scene_.nodes.size()) reject(doc_.where("nodes"), "a node is its own ancestor");
  }

  GltfAnimation animation(const json& a) {
    const std::string item = fmt::format("animations[{}]", scene_.animations.size());
    GltfAnimation result;
    result.name = doc_.text(a, "name");
    const auto is_list = [&a](const char* name) { return a.is_object() && a.contains(name) && a[name].is_array(); };
    if (!is_list("channels") || !is_list("samplers")) reject(doc_.where(item), "has no channels or no samplers");
    for (const json& c : a["channels"]) {
      const auto sampler = doc_.integer(c, "sampler", item);
      if (!sampler || *sampler < 0 || *sampler >= static_cast<long long>(a["samplers"].size()) ||
          !c.contains("target")) {
        reject(doc_.where(item), "a channel has no sampler or no target");
      }
      const json& target = c["target"];
      const auto node = doc_.row(target, "node", "nodes", item);
      const std::string path = doc_.text(target, "path");
      if (!node || (path != "translation" && path != "rotation" && path != "scale" && path != "weights")) continue;
      result.channels.push_back(channel(a["samplers"][static_cast<std::size_t>(*sampler)], *node, path, item));
    }
    return result;
  }

  GltfChannel channel(const json& sampler, int node, const std::string& path, const std::string& item) {
    GltfChannel result;
    result.node = node;
    result.path = path == "translation" ? GltfPath::translation
                  : path == "rotation"  ? GltfPath::rotation
                  : path == "scale"     ? GltfPath::scale
                                        : GltfPath::weights;
    const auto input = doc_.row(sampler, "input", "accessors", item);
    const auto output = doc_.row(sampler, "output", "accessors", item);
    if (!input || !output) reject(doc_.where(item), "a sampler has no input or no output");
    const std::string interpolation = doc_.text(sampler, "interpolation");
    result.step = interpolation == "STEP";
    const GltfDocument::Values times = doc_.values(*input, 1);
    result.times.assign(times.data(), times.data() + times.size());
    if (!std::is_sorted(result.times.begin(), result.times.end())) reject(doc_.where(item), "times do not ascend");
    const int columns = result.path == GltfPath::weights ? 1 : result.path == GltfPath::rotation ? 4 : 3;
    GltfDocument::Values values = doc_.values(*output, columns);
    const Eigen::Index frames = times.size();
    const Eigen::Index tangents = interpolation == "CUBICSPLINE" ? 3 : 1;  // in-tangent, value, out-tangent
    const Eigen::Index each = values.size() / frames / tangents;
    if (each < 1 || each * frames * tangents != values.size() || (columns > 1 && each != columns)) {
      reject(doc_.where(item), "a sampler has another number of values than of times");
    }
    const Eigen::Map<const GltfDocument::Values> rows(values.data(), frames * tangents, each);
    result.values.resize(frames, each);
    for (Eigen::Index f = 0; f < frames; ++f) result.values.row(f) = rows.row(f * tangents + tangents / 2);
    return result;
  }

  GltfDocument doc_;
  GltfScene scene_;
};

}  // namespace

GltfScene parse_gltf(std::string_view bytes, const std::string& where, const std::string& folder) {
  return GltfReader(bytes, where, folder).read();
}

GltfScene read_gltf(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return parse_gltf(read_bytes(path), path, folder.empty() ? "." : folder);
}

std::vector<Eigen::Affine3d> world_transforms(const GltfScene& scene) {
  std::vector<Eigen::Affine3d> world(scene.nodes.size(), Eigen::Affine3d::Identity());
  std::vector<std::pair<int, Eigen::Affine3d>> waiting;
  for (const int root : scene.roots) waiting.emplace_back(root, Eigen::Affine3d::Identity());
  while (!waiting.empty()) {
    const auto [row, parent] = waiting.back();
    waiting.pop_back();
    const GltfNode& node = scene.nodes[static_cast<std::size_t>(row)];
    const Eigen::Affine3d here =
        parent * (Eigen::Translation3d(node.translation) * node.rotation * Eigen::Scaling(node.scale));
    world[static_cast<std::size_t>(row)] = here;
    for (const int child : node.children) waiting.emplace_back(child, here);
  }
  return world;
}

PolygonMesh flattened(const GltfScene& scene) {
  PolygonMesh result;
  const auto world = world_transforms(scene);
  Eigen::Index vertices = 0;
  for (const GltfNode& node : scene.nodes) {
    if (node.mesh < 0) continue;
    for (const auto& p : scene.meshes[static_cast<std::size_t>(node.mesh)].primitives) vertices += p.positions.rows();
  }
  if (vertices > most_vertices) {
    fail(fmt::format("the scene has {} vertices, more than one mesh can hold", vertices), "read its parts one by one");
  }
  result.V.resize(vertices, 3);
  Eigen::Index first = 0;
  for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
    if (scene.nodes[n].mesh < 0) continue;
    result.groups.push_back(scene.nodes[n].name);
    for (const auto& p : scene.meshes[static_cast<std::size_t>(scene.nodes[n].mesh)].primitives) {
      for (Eigen::Index i = 0; i < p.positions.rows(); ++i) {
        result.V.row(first + i) = (world[n] * Vector3d(p.positions.row(i).transpose().cast<double>())).transpose();
      }
      for (Eigen::Index t = 0; t < p.triangles.rows(); ++t) {
        const Eigen::RowVector3i c = p.triangles.row(t);
        if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue;  // strips join with triangles without area
        const int offset = static_cast<int>(first);
        result.faces.push_back({c[0] + offset, c[1] + offset, c[2] + offset});
        result.face_group.push_back(static_cast<int>(result.groups.size()) - 1);
      }
      first += p.positions.rows();
    }
  }
  return result;
}

}  // namespace phiz
