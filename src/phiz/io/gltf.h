// SPDX-License-Identifier: GPL-3.0-or-later
/// glTF 2.0 and its binary form GLB: meshes, materials, morph targets, node hierarchy, animation.
/// Metres, +y up, +z forward, as the head frame. Colours are linear RGB; texture coordinates have v pointing down.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <string_view>
#include <vector>

#include "phiz/geometry/mesh.h"

namespace phiz {

using GltfVectors = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;
using GltfTexels = Eigen::Matrix<float, Eigen::Dynamic, 2, Eigen::RowMajor>;
using GltfColours = Eigen::Matrix<float, Eigen::Dynamic, 4, Eigen::RowMajor>;
using GltfTriangles = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;

struct GltfMaterial {
  std::string name;
  Eigen::Vector4d base_colour = Eigen::Vector4d::Ones();  ///< linear red, green, blue, alpha
  double metallic = 0;
  double roughness = 0.5;
  bool double_sided = false;
  std::string base_colour_png = {};  ///< bytes of a PNG file (sRGB) that the base colour is multiplied with; or empty
};

/// Differences that are added, times the target's weight.
struct GltfTarget {
  GltfVectors positions;
  GltfVectors normals;  ///< as many rows, or empty
};

/// Triangles with one material.
struct GltfPrimitive {
  GltfVectors positions;
  GltfVectors normals;  ///< unit, as many rows as positions; or empty
  GltfTexels texels;    ///< or empty
  GltfColours colours;  ///< linear RGBA in [0, 1]; or empty
  GltfTriangles triangles;
  std::vector<GltfTarget> targets;
  int material = -1;  ///< row of GltfScene::materials, or -1
};

struct GltfMesh {
  std::string name;
  std::vector<GltfPrimitive> primitives;       ///< all with the same number of targets
  std::vector<std::string> target_names = {};  ///< one per target, or empty
};

struct GltfNode {
  std::string name;
  Vector3d translation = Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Vector3d scale = Vector3d::Ones();
  int mesh = -1;                   ///< row of GltfScene::meshes, or -1
  std::vector<int> children = {};  ///< rows of GltfScene::nodes; the nodes form trees
};

enum class GltfPath { translation, rotation, scale, weights };

/// One property of one node over time. `values`: a row per time; 3 columns, 4 (quaternion x y z w), or one per target.
struct GltfChannel {
  int node = 0;
  GltfPath path = GltfPath::translation;
  bool step = false;         ///< keeps each value until the next time instead of interpolating
  std::vector<float> times;  ///< seconds, ascending
  Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> values;
};

struct GltfAnimation {
  std::string name;
  std::vector<GltfChannel> channels;
};

struct GltfScene {
  std::vector<GltfMaterial> materials;
  std::vector<GltfMesh> meshes;
  std::vector<GltfNode> nodes;
  std::vector<int> roots;  ///< rows of `nodes`
  std::vector<GltfAnimation> animations;
  std::string notes_json;  ///< a JSON object for asset.extras, or empty
};

/// Writes .glb, or .gltf with its buffer inside. Throws phiz::Error(failure) when the scene is inconsistent.
void write_gltf(const std::string& path, const GltfScene& scene);

/// Reads .glb or .gltf with buffers inside or in files beside it. Points, lines, cameras, lights, skins and textures
/// are left out; strips and fans become triangles; matrices become translation, rotation and scale; of cubic
/// animation curves the values are kept. Every index, range, offset and number is checked: throws
/// phiz::Error(bad_input) naming the item, also for required extensions and sparse accessors it does not know.
GltfScene read_gltf(const std::string& path);
/// `folder`: where buffers in other files are looked for; empty: such buffers are refused.
GltfScene parse_gltf(std::string_view bytes, const std::string& where, const std::string& folder = {});

/// World transform of every node at rest.
std::vector<Eigen::Affine3d> world_transforms(const GltfScene& scene);

/// All meshes of the scene, placed by their nodes, as one mesh; one group per node.
PolygonMesh flattened(const GltfScene& scene);

}  // namespace phiz
