// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/io/take_gltf.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "phiz/anatomy/skin_ride.h"
#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/io/file_bytes.h"
#include "phiz/io/frame_compression.h"
#include "phiz/io/gltf_surface.h"
#include "phiz/io/head_materials.h"

namespace phiz {

namespace {

/// Differences of the normals per shape that, with the shapes' weights, come nearest to the normals of all frames.
/// The columns of the weights are orthogonal, so that each shape is fitted alone.
std::vector<MatrixX3d> normal_shapes(const std::vector<const MatrixX3f*>& frames, const TriangleMesh& rest,
                                     const Eigen::MatrixXf& weights) {
  const MatrixX3d rest_normals = shading_normals(rest.V, rest.F);
  const auto shapes = static_cast<std::size_t>(weights.cols());
  std::vector<MatrixX3d> sums(shapes, MatrixX3d::Zero(rest_normals.rows(), 3));
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const MatrixX3d change = shading_normals(frames[f]->cast<double>(), rest.F) - rest_normals;
    parallel_for(
        weights.cols(),
        [&](std::ptrdiff_t k) {
          sums[static_cast<std::size_t>(k)] += weights(static_cast<Eigen::Index>(f), k) * change;
        },
        1);
  }
  for (Eigen::Index k = 0; k < weights.cols(); ++k) {
    const double norm = weights.col(k).cast<double>().squaredNorm();
    if (norm > 0) sums[static_cast<std::size_t>(k)] /= norm;
  }
  return sums;
}

class TakeScene {
 public:
  TakeScene(const Take& take, const TakeGltfOptions& options) : take_(take), options_(options) {}

  GltfScene build(TakeGltfReport& report) {
    report.frames = static_cast<int>(take_.frames.size());
    set_times();
    const int head = add_node("head", -1);
    scene_.roots = {head};
    add_skin(head, report);
    for (const Part& part : take_.parts) add_part(part, head);
    animate_nodes(head);
    if (!animation_.channels.empty()) {
      animation_.name = "take";
      scene_.animations.push_back(std::move(animation_));
    }
    scene_.notes_json = nlohmann::json{
        {"frames", report.frames},
        {"frameRate", take_.frame_rate},
        {"model", take_.model},
        {"skinMaxErrorMillimetres", 1e3 * report.max_error},
        {"skinShapes",
         report.shapes}}.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    return std::move(scene_);
  }

 private:
  void set_times() {
    for (std::size_t f = 0; f < take_.frames.size(); ++f) {
      times_.push_back(static_cast<float>(take_.frames[f].time - take_.frames[0].time));
    }
    const auto stalled = std::adjacent_find(times_.begin(), times_.end(), [](float a, float b) { return !(a < b); });
    if (stalled == times_.end()) return;
    for (std::size_t f = 0; f < times_.size(); ++f) {
      times_[f] = static_cast<float>(static_cast<double>(f) / take_.frame_rate);
    }
  }

  int add_node(const std::string& name, int parent, int mesh = -1) {
    const int row = static_cast<int>(scene_.nodes.size());
    scene_.nodes.push_back({.name = name, .mesh = mesh});
    if (parent >= 0) scene_.nodes[static_cast<std::size_t>(parent)].children.push_back(row);
    return row;
  }

  int material_for(const std::string& part) {
    const GltfMaterial material = head_material(part);
    for (std::size_t i = 0; i < scene_.materials.size(); ++i) {
      if (scene_.materials[i].name == material.name) return static_cast<int>(i);
    }
    scene_.materials.push_back(material);
    return static_cast<int>(scene_.materials.size()) - 1;
  }

  int add_mesh(GltfMesh mesh) {
    scene_.meshes.push_back(std::move(mesh));
    return static_cast<int>(scene_.meshes.size()) - 1;
  }

  GltfChannel& add_channel(int node, GltfPath path, Eigen::Index columns) {
    GltfChannel channel;
    channel.node = node;
    channel.path = path;
    channel.times = times_;
    channel.values.setZero(static_cast<Eigen::Index>(times_.size()), columns);
    return animation_.channels.emplace_back(std::move(channel));
  }

  void add_skin(int head, TakeGltfReport& report) {
    std::vector<const MatrixX3f*> frames;
    for (const TakeFrame& frame : take_.frames) {
      if (frame.skin.rows() != take_.skin.V.rows()) fail("a frame of the take has another number of skin vertices");
      frames.push_back(&frame.skin);
    }
    const CompressedFrames compressed = add_deforming("skin", take_.skin, frames, head);
    report.vertices = static_cast<int>(scene_.meshes.back().primitives[0].positions.rows());
    report.shapes = static_cast<int>(compressed.shapes.size());
    report.max_error = compressed.max_error;
    report.rms_error = compressed.rms_error;
  }

  /// A mesh that every frame gives other vertices, as morph targets.
  CompressedFrames add_deforming(const std::string& name, const TriangleMesh& rest,
                                 const std::vector<const MatrixX3f*>& frames, int parent) {
    CompressedFrames compressed = compress_frames(rest.V, frames, options_.tolerance);
    const GltfSurface surface(rest);
    GltfMesh mesh{.name = name, .primitives = {surface.primitive(rest.V, material_for(name))}};
    const auto normals = normal_shapes(frames, rest, compressed.weights);
    for (std::size_t k = 0; k < compressed.shapes.size(); ++k) {
      mesh.primitives[0].targets.push_back(
          {surface.spread(compressed.shapes[k].cast<double>()), surface.spread(normals[k])});
      mesh.target_names.push_back(fmt::format("shape{}", k));
    }
    const int node = add_node(name, parent, add_mesh(std::move(mesh)));
    if (!compressed.shapes.empty())
      add_channel(node, GltfPath::weights, compressed.weights.cols()).values = compressed.weights;
    return compressed;
  }

  void add_riding_part(const Part& part, int head) {
    const SkinRide ride(take_.skin, part.mesh);
    std::vector<MatrixX3f> positions;
    for (const TakeFrame& frame : take_.frames) positions.emplace_back(ride(frame.skin.cast<double>()).cast<float>());
    std::vector<const MatrixX3f*> frames;
    for (const MatrixX3f& frame : positions) frames.push_back(&frame);
    add_deforming(part.name, part.mesh, frames, head);
  }

  /// The node that carries a part, made when the first part needs it; its position at rest.
  struct CarrierNode {
    int node = -1;
    Vector3d centre = Vector3d::Zero();
  };

  CarrierNode carrier_node(Carrier carrier, int head) {
    CarrierNode& place = carriers_[carrier];
    if (place.node >= 0) return place;
    if (carrier == Carrier::mandible) {
      place = {add_node("jaw", head), take_.joint.centre};
    } else if (carrier == Carrier::left_eye) {
      place = {add_node("leftEye", head), take_.left_eye_centre};
    } else if (carrier == Carrier::right_eye) {
      place = {add_node("rightEye", head), take_.right_eye_centre};
    } else {
      place = {head, Vector3d::Zero()};
    }
    if (place.node != head) scene_.nodes[static_cast<std::size_t>(place.node)].translation = place.centre;
    return place;
  }

  void add_part(const Part& part, int head) {
    if (part.mesh.F.rows() == 0) return;
    if (part.carrier == Carrier::flesh) {
      add_riding_part(part, head);
      return;
    }
    const CarrierNode carrier = carrier_node(part.carrier, head);
    TriangleMesh local = part.mesh;
    local.V.rowwise() -= carrier.centre.transpose();
    const GltfMaterial look = head_material(part.name);
    if (!look.base_colour_png.empty()) local = with_eye_texture_coordinates(local, Vector3d::Zero());
    const GltfSurface surface(local);
    GltfMesh mesh{.name = part.name, .primitives = {surface.primitive(local.V, material_for(part.name))}};
    std::vector<Eigen::Index> columns;  // of the weights, per target
    const MatrixX3d rest_normals = shading_normals(local.V, local.F);
    for (const auto& [name, displacement] : part.shapes) {
      const auto place = std::find(take_.expressions.begin(), take_.expressions.end(), name);
      if (place == take_.expressions.end()) continue;
      const Eigen::Index column = place - take_.expressions.begin();
      const bool used = std::any_of(take_.frames.begin(), take_.frames.end(),
                                    [column](const TakeFrame& f) { return f.part_weights[column] != 0; });
      if (!used) continue;
      const MatrixX3d normals = shading_normals(local.V + displacement, local.F) - rest_normals;
      mesh.primitives[0].targets.push_back({surface.spread(displacement), surface.spread(normals)});
      mesh.target_names.push_back(name);
      columns.push_back(column);
    }
    const int row = add_mesh(std::move(mesh));
    // A carrier named as its only part is that part.
    GltfNode& carrying = scene_.nodes[static_cast<std::size_t>(carrier.node)];
    int node = carrier.node;
    if (carrying.name == part.name && carrying.mesh < 0) {
      carrying.mesh = row;
    } else {
      node = add_node(part.name, carrier.node, row);
    }
    if (columns.empty()) return;
    GltfChannel& channel = add_channel(node, GltfPath::weights, static_cast<Eigen::Index>(columns.size()));
    for (std::size_t f = 0; f < take_.frames.size(); ++f) {
      for (std::size_t k = 0; k < columns.size(); ++k) {
        channel.values(static_cast<Eigen::Index>(f), static_cast<Eigen::Index>(k)) =
            static_cast<float>(take_.frames[f].part_weights[columns[k]]);
      }
    }
  }

  template <class Rotation>
  void animate_rotation(int node, Rotation&& rotation) {
    GltfChannel& channel = add_channel(node, GltfPath::rotation, 4);
    Eigen::Quaterniond last = Eigen::Quaterniond::Identity();
    for (std::size_t f = 0; f < take_.frames.size(); ++f) {
      Eigen::Quaterniond q(Matrix3d(rotation(take_.frames[f])));
      q.normalize();
      if (q.dot(last) < 0) q.coeffs() = -q.coeffs();  // interpolation goes the short way
      last = q;
      channel.values.row(static_cast<Eigen::Index>(f)) = q.coeffs().cast<float>().normalized().transpose();
    }
  }

  template <class Translation>
  void animate_translation(int node, Translation&& translation) {
    GltfChannel& channel = add_channel(node, GltfPath::translation, 3);
    for (std::size_t f = 0; f < take_.frames.size(); ++f) {
      channel.values.row(static_cast<Eigen::Index>(f)) =
          Vector3d(translation(take_.frames[f])).template cast<float>().transpose();
    }
  }

  void animate_nodes(int head) {
    if (take_.frames.empty()) return;
    animate_translation(head, [](const TakeFrame& f) -> Vector3d { return f.head.translation(); });
    animate_rotation(head, [](const TakeFrame& f) -> Matrix3d { return f.head.linear(); });
    for (const auto& [carrier, place] : carriers_) {
      if (carrier == Carrier::mandible) {
        // Positions below the jaw node are relative to the joint's centre.
        const Vector3d centre = place.centre;
        animate_translation(place.node,
                            [&](const TakeFrame& f) -> Vector3d { return jaw_transform(take_.joint, f.jaw) * centre; });
        animate_rotation(place.node,
                         [&](const TakeFrame& f) -> Matrix3d { return jaw_transform(take_.joint, f.jaw).linear(); });
      } else if (carrier == Carrier::left_eye) {
        animate_rotation(place.node, [](const TakeFrame& f) { return f.left_eye; });
      } else if (carrier == Carrier::right_eye) {
        animate_rotation(place.node, [](const TakeFrame& f) { return f.right_eye; });
      }
    }
  }

  const Take& take_;
  const TakeGltfOptions& options_;
  GltfScene scene_;
  GltfAnimation animation_;
  std::vector<float> times_;
  std::map<Carrier, CarrierNode> carriers_;
};

}  // namespace

GltfScene take_scene(const Take& take, const TakeGltfOptions& options, TakeGltfReport* report) {
  TakeGltfReport own;
  return TakeScene(take, options).build(report != nullptr ? *report : own);
}

TakeGltfReport export_take_gltf(const Take& take, const std::string& path, const TakeGltfOptions& options) {
  const std::string extension = lower_extension(path);
  if (extension != ".glb" && extension != ".gltf") {
    throw Error(ErrorKind::usage, fmt::format("{}: expected a name that ends in .glb or .gltf", path));
  }
  TakeGltfReport report;
  write_gltf(path, take_scene(take, options, &report));
  return report;
}

}  // namespace phiz
