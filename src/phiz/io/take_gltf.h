// SPDX-License-Identifier: GPL-3.0-or-later
/// A take as an animated glTF scene.
#pragma once

#include <string>

#include "phiz/face/take.h"
#include "phiz/io/gltf.h"

namespace phiz {

struct TakeGltfOptions {
  double tolerance = 5e-5;  ///< largest distance of a skin vertex from the take, metres
};

/// What the export achieved.
struct TakeGltfReport {
  int frames = 0;
  int vertices = 0;      ///< of the skin in the file (seams doubled)
  int shapes = 0;        ///< morph targets of the skin
  double max_error = 0;  ///< of the skin over all vertices and frames, metres
  double rms_error = 0;
};

/// The scene: node "head" (animated head pose) with the children "skin" (morph targets "shape0", "shape1", ... with
/// animated weights; normals follow), "leftEye" and "rightEye" (animated rotation about the eye's centre), "jaw"
/// (animated rigid motion about the joint; mandible, lower teeth, tongue below it) and one node for every other part,
/// named as the part. Parts with shapes get a morph target per shape that the take uses. One animation, "take".
GltfScene take_scene(const Take& take, const TakeGltfOptions& options = {}, TakeGltfReport* report = nullptr);

/// Writes the scene as .glb or .gltf; the report also stands in asset.extras of the file. Throws phiz::Error(usage)
/// for another extension.
TakeGltfReport export_take_gltf(const Take& take, const std::string& path, const TakeGltfOptions& options = {});

}  // namespace phiz
