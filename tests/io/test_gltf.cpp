// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "io/expect_error.h"
#include "io/sample_nouns.h"
#include "io/temporary_folder.h"
#include "phiz/io/base64.h"
#include "phiz/io/file_bytes.h"
#include "phiz/io/frame_compression.h"
#include "phiz/io/gltf.h"
#include "phiz/io/mesh_file.h"
#include "phiz/io/obj.h"
#include "phiz/io/point_cache.h"
#include "phiz/io/take_export.h"
#include "phiz/io/take_gltf.h"

namespace phiz {
namespace {

GltfPrimitive triangle() {
  GltfPrimitive p;
  p.positions.resize(3, 3);
  p.positions << 0, 0, 0, 0.5f, 0, 0, 0, 0.5f, 0;
  p.normals = GltfVectors::Zero(3, 3);
  p.normals.col(2).setOnes();
  p.texels = GltfTexels::Zero(3, 2);
  p.colours = GltfColours::Constant(3, 4, 0.5f);
  p.triangles.resize(1, 3);
  p.triangles << 0, 1, 2;
  p.targets = {{p.positions, p.normals}, {2 * p.positions, GltfVectors()}};
  p.targets[1].normals = p.normals;
  p.material = 0;
  return p;
}

GltfScene sample_scene() {
  GltfScene scene;
  GltfMaterial material;
  material.name = "red";
  material.base_colour << 1, 0.25, 0.125, 1;
  material.double_sided = true;
  scene.materials = {material};
  GltfMesh mesh;
  mesh.name = "triangle";
  mesh.primitives = {triangle()};
  mesh.target_names = {"open", "smile"};
  scene.meshes = {mesh};
  GltfNode parent, child;
  parent.name = "parent";
  parent.translation << 1, 2, 3;
  parent.children = {1};
  child.name = "child";
  child.mesh = 0;
  child.rotation = Eigen::AngleAxisd(0.5, Vector3d::UnitY());
  child.scale << 2, 2, 2;
  scene.nodes = {parent, child};
  scene.roots = {0};
  GltfAnimation animation;
  animation.name = "move";
  GltfChannel weights, rotation;
  weights.node = 1;
  weights.path = GltfPath::weights;
  weights.times = rotation.times = {0, 0.5f, 1};
  weights.values.resize(3, 2);
  weights.values << 0, 0, 1, 0.5f, 0, 1;
  rotation.node = 0;
  rotation.path = GltfPath::rotation;
  rotation.step = true;
  rotation.values.setZero(3, 4);
  rotation.values.col(3).setOnes();
  animation.channels = {weights, rotation};
  scene.animations = {animation};
  return scene;
}

TEST(Gltf, a_scene_reads_back_the_same_from_both_forms) {
  const TemporaryFolder folder;
  const GltfScene scene = sample_scene();
  for (const char* name : {"a.glb", "a.gltf"}) {
    write_gltf(folder.file(name), scene);
    const GltfScene back = read_gltf(folder.file(name));
    ASSERT_EQ(back.materials.size(), 1u);
    EXPECT_EQ(back.materials[0].base_colour, scene.materials[0].base_colour);
    EXPECT_TRUE(back.materials[0].double_sided);
    ASSERT_EQ(back.meshes.size(), 1u);
    const GltfPrimitive& p = back.meshes[0].primitives[0];
    const GltfPrimitive& q = scene.meshes[0].primitives[0];
    EXPECT_EQ(p.positions, q.positions);
    EXPECT_EQ(p.normals, q.normals);
    EXPECT_EQ(p.texels, q.texels);
    EXPECT_EQ(p.colours, q.colours);
    EXPECT_EQ(p.triangles, q.triangles);
    ASSERT_EQ(p.targets.size(), 2u);
    EXPECT_EQ(p.targets[1].positions, q.targets[1].positions);
    EXPECT_EQ(back.meshes[0].target_names, scene.meshes[0].target_names);
    ASSERT_EQ(back.nodes.size(), 2u);
    EXPECT_EQ(back.roots, scene.roots);
    EXPECT_TRUE(world_transforms(back)[1].isApprox(world_transforms(scene)[1]));
    ASSERT_EQ(back.animations.size(), 1u);
    ASSERT_EQ(back.animations[0].channels.size(), 2u);
    EXPECT_EQ(back.animations[0].channels[0].values, scene.animations[0].channels[0].values);
    EXPECT_EQ(back.animations[0].channels[0].times, scene.animations[0].channels[0].times);
    EXPECT_TRUE(back.animations[0].channels[1].step);
  }
  const PolygonMesh flat = read_mesh(folder.file("a.glb"));
  EXPECT_EQ(flat.faces.size(), 1u);
  EXPECT_LT((flat.V.row(0) - Eigen::RowVector3d(1, 2, 3)).norm(), 1e-12);
}

TEST(Gltf, base64_is_its_own_inverse) {
  std::string bytes;
  for (int i = 0; i < 40; ++i) {
    EXPECT_EQ(from_base64(to_base64(bytes)), bytes);
    bytes += static_cast<char>(37 * i);
  }
  EXPECT_FALSE(from_base64("ab!d"));
  EXPECT_FALSE(from_base64("abcde"));
}

std::string document(const std::string& members) {
  return R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":36,"uri":"data:;base64,)" +
         to_base64(std::string(36, '\0')) + R"("}],"bufferViews":[{"buffer":0,"byteLength":36}],)" + members + "}";
}

TEST(Gltf, names_the_item_that_is_wrong) {
  const std::string mesh = R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[)";
  const auto accessor = [&](const std::string& a) { return document(mesh + a + "]"); };
  EXPECT_NO_THROW(parse_gltf(accessor(R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"})"), "a"));
  EXPECT_REJECTED(parse_gltf(accessor(R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"})"), "a"),
                  "accessors[0]");
  EXPECT_REJECTED(parse_gltf(accessor(R"({"bufferView":0,"componentType":5126,"count":1e12,"type":"VEC3"})"), "a"),
                  "do not fit");
  EXPECT_REJECTED(parse_gltf(accessor(R"({"bufferView":1,"componentType":5126,"count":3,"type":"VEC3"})"), "a"),
                  "bufferView");
  EXPECT_REJECTED(parse_gltf(accessor(R"({"bufferView":0,"componentType":1,"count":3,"type":"VEC3"})"), "a"),
                  "unknown");
  EXPECT_REJECTED(parse_gltf(document(R"("meshes":[{"primitives":[{"attributes":{"POSITION":7}}]}])"), "a"),
                  "POSITION");
  EXPECT_REJECTED(parse_gltf(document(R"("nodes":[{"children":[1]},{"children":[0]}])"), "a"), "ancestor");
  EXPECT_REJECTED(parse_gltf(document(R"("nodes":[{"children":[2]},{"children":[2]},{}])"), "a"), "two parents");
  EXPECT_REJECTED(parse_gltf(document(R"("nodes":[{}],"scenes":[{"nodes":[1]}])"), "a"), "scenes[0]");
  EXPECT_REJECTED(parse_gltf(document(R"("nodes":[{}],"scenes":[{"nodes":[0]}],"scene":4)"), "a"), "scene");
  EXPECT_REJECTED(parse_gltf(document(R"("meshes":[{"primitives":[]}])"), "a"), "no primitives");
  EXPECT_REJECTED(parse_gltf(R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":1,"uri":"none.bin"}]})", "a", "."),
                  "a: buffers[0]: ");
  EXPECT_REJECTED(parse_gltf(document(R"("extensionsRequired":["KHR_draco_mesh_compression"])"), "a"), "KHR_draco");
  EXPECT_REJECTED(parse_gltf(R"({"asset":{"version":"1.0"}})", "a"), "version 2");
  EXPECT_REJECTED(parse_gltf("x", "a"), "neither GLB");
  EXPECT_REJECTED(parse_gltf(std::string(100000, '['), "a"), "nested");
  EXPECT_REJECTED(
      parse_gltf(R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":1,"uri":"../etc/passwd"}]})", "a", "."),
      "beside it");
}

TEST(FrameCompression, reaches_the_tolerance_with_few_shapes) {
  const Take take = sample_take(60, 20);
  std::vector<const MatrixX3f*> frames;
  for (const TakeFrame& frame : take.frames) frames.push_back(&frame.skin);
  const CompressedFrames c = compress_frames(take.skin.V, frames, 5e-5);
  EXPECT_LE(c.max_error, 5e-5);
  EXPECT_LE(c.shapes.size(), 3u);  // sin(a + b) is a sum of two products
  double largest = 0;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    MatrixX3d made = take.skin.V;
    for (std::size_t k = 0; k < c.shapes.size(); ++k) {
      made += c.weights(static_cast<Eigen::Index>(f), static_cast<Eigen::Index>(k)) * c.shapes[k].cast<double>();
    }
    largest = std::max(largest, (made - frames[f]->cast<double>()).rowwise().norm().maxCoeff());
  }
  EXPECT_NEAR(largest, c.max_error, 1e-7);
  EXPECT_EQ(compress_frames(take.skin.V, {}, 5e-5).shapes.size(), 0u);
}

/// Value of a channel at a frame; the rest value where the node has no such channel.
const GltfChannel* channel_of(const GltfScene& scene, int node, GltfPath path) {
  for (const GltfChannel& c : scene.animations[0].channels) {
    if (c.node == node && c.path == path) return &c;
  }
  return nullptr;
}

int node_named(const GltfScene& scene, const std::string& name) {
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    if (scene.nodes[i].name == name) return static_cast<int>(i);
  }
  ADD_FAILURE() << "no node " << name;
  return 0;
}

/// The scene with its nodes as they are in a frame.
GltfScene posed(GltfScene scene, Eigen::Index frame) {
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    GltfNode& node = scene.nodes[i];
    if (const auto* c = channel_of(scene, static_cast<int>(i), GltfPath::translation)) {
      node.translation = c->values.row(frame).transpose().cast<double>();
    }
    if (const auto* c = channel_of(scene, static_cast<int>(i), GltfPath::rotation)) {
      node.rotation.coeffs() = c->values.row(frame).transpose().cast<double>();
    }
  }
  return scene;
}

TEST(TakeGltf, the_file_plays_the_take) {
  const TemporaryFolder folder;
  const Take take = sample_take(40, 12);
  const TakeGltfReport report = export_take_gltf(take, folder.file("a.glb"));
  EXPECT_EQ(report.frames, 40);
  EXPECT_LE(report.max_error, 5e-5);
  const GltfScene scene = read_gltf(folder.file("a.glb"));
  for (const char* name : {"head", "skin", "leftEye", "rightEye", "jaw", "skull", "tongue"}) node_named(scene, name);
  const int skin = node_named(scene, "skin");
  const GltfPrimitive& surface =
      scene.meshes[static_cast<std::size_t>(scene.nodes[static_cast<std::size_t>(skin)].mesh)].primitives[0];
  const GltfChannel* weights = channel_of(scene, skin, GltfPath::weights);
  ASSERT_NE(weights, nullptr);
  for (const Eigen::Index f : {0, 7, 39}) {
    const TakeFrame& frame = take.frames[static_cast<std::size_t>(f)];
    GltfVectors made = surface.positions;
    GltfVectors normals = surface.normals;
    for (std::size_t k = 0; k < surface.targets.size(); ++k) {
      made += weights->values(f, static_cast<Eigen::Index>(k)) * surface.targets[k].positions;
      normals += weights->values(f, static_cast<Eigen::Index>(k)) * surface.targets[k].normals;
    }
    // The skin has no seams, so that its vertices come in order of first use; compare bounding boxes and one face.
    EXPECT_LT((made.colwise().maxCoeff() - frame.skin.colwise().maxCoeff()).norm(), 1e-4);
    EXPECT_LT((made.colwise().minCoeff() - frame.skin.colwise().minCoeff()).norm(), 1e-4);
    EXPECT_GT(normals.rowwise().normalized().col(2).minCoeff(), 0.5f);
    EXPECT_NEAR(weights->times[static_cast<std::size_t>(f)], frame.time, 1e-6);

    const auto world = world_transforms(posed(scene, f));
    for (const Part& part : take.parts) {
      const int node = node_named(scene, part.name);
      const auto& mesh = scene.meshes[static_cast<std::size_t>(scene.nodes[static_cast<std::size_t>(node)].mesh)];
      const Eigen::Isometry3d expected = part_transform(take, frame, part);
      for (Eigen::Index i = 0; i < mesh.primitives[0].positions.rows(); ++i) {
        const Vector3d here = world[static_cast<std::size_t>(node)] *
                              Vector3d(mesh.primitives[0].positions.row(i).transpose().cast<double>());
        double nearest = 1;
        for (Eigen::Index v = 0; v < part.mesh.V.rows(); ++v) {
          nearest = std::min(nearest, (expected * Vector3d(part.mesh.V.row(v)) - here).norm());
        }
        EXPECT_LT(nearest, 1e-6) << part.name;
      }
    }
  }
  EXPECT_NE(channel_of(scene, node_named(scene, "tongue"), GltfPath::weights), nullptr);
}

TEST(TakeGltf, a_take_without_frames_or_parts_is_a_still) {
  Take take = sample_take(0);
  take.parts.clear();
  const GltfScene scene = take_scene(take);
  EXPECT_TRUE(scene.animations.empty());
  EXPECT_EQ(scene.meshes.size(), 1u);
}

TEST(TakeGltf, passes_the_khronos_validator) {
  const std::string tools = "build/tools";  // where scripts/setup --all puts it
  if (!std::filesystem::exists(tools + "/node_modules/gltf-validator")) {
    GTEST_SKIP() << "gltf-validator is not installed: scripts/setup --all";
  }
  const TemporaryFolder folder;
  export_take_gltf(sample_take(30, 12), folder.file("a.glb"));
  export_take_gltf(sample_take(0), folder.file("still.gltf"));
  write_gltf(folder.file("scene.gltf"), sample_scene());
  write_mesh(folder.file("mesh.glb"), sample_tetrahedron());
  for (const char* name : {"a.glb", "still.gltf", "scene.gltf", "mesh.glb"}) {
    const std::string command = "node tests/app/check_glb.mjs " + folder.file(name) + " " + tools;
    EXPECT_EQ(std::system(command.c_str()), 0) << name;
  }
}

TEST(TakeExport, sequences_and_caches_hold_every_frame) {
  const TemporaryFolder folder;
  const Take take = sample_take(5);
  EXPECT_EQ(export_take_obj_sequence(take, folder.file("seq/a.obj")), 5);
  const PolygonMesh last = read_obj(folder.file("seq/a.0004.obj"));
  const Vector3d expected = take.frames[4].head * Vector3d(take.frames[4].skin.row(3).transpose().cast<double>());
  EXPECT_LT((last.V.row(3).transpose() - expected).norm(), 1e-7);
  for (const char* name : {"a.pc2", "a.mdd"}) {
    export_take_point_cache(take, folder.file(name));
    const PointCache cache = std::string(name) == "a.pc2" ? read_pc2(folder.file(name)) : read_mdd(folder.file(name));
    ASSERT_EQ(cache.frames.size(), 5u);
    EXPECT_LT((cache.frames[4].row(3).transpose().cast<double>() - expected).norm(), 1e-7);
    EXPECT_EQ(read_obj(folder.file("a.obj")).V.rows(), take.skin.V.rows());
  }
  message_of([&] { export_take_point_cache(take, folder.file("a.abc")); }, ErrorKind::usage);
}

}  // namespace
}  // namespace phiz
