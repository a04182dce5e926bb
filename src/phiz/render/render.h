// SPDX-License-Identifier: GPL-3.0-or-later
/// The renderer: one picture of a scene by ray tracing (Embree), deterministic for any number of threads.
#pragma once

#include "phiz/geometry/image.h"
#include "phiz/render/camera.h"
#include "phiz/render/scene.h"

namespace phiz {

/// What the picture shows of the surfaces.
enum class Shading {
  lit,      ///< materials under the lights
  normals,  ///< shading normals in the camera's frame as colours (x, y, z to red, green, blue)
  depth,    ///< distance along the viewing axis, near = white
};

struct RenderOptions {
  int samples = 8;              ///< rays per pixel through the lens: edges and highlights, 1 to 256
  int ambient_samples = 6;      ///< ambient-occlusion rays per pixel, shared by 4 x 4 pixels, 0 (no occlusion) to 256
  int light_samples = 2;        ///< shadow rays per light and pixel, shared likewise, 0 (no shadows) to 256
  double ambient_reach = 0.35;  ///< how far ambient occlusion looks, as a share of the scene's diagonal
  double exposure = 1;          ///< multiplies all light
  Shading shading = Shading::lit;
  bool fast_build = false;  ///< cheaper ray structure: for films, where it is built once per frame
};

/// For frames of a film: a third of the rays of a still.
RenderOptions film_options();
/// For single pictures that are looked at closely.
RenderOptions still_options();

/// Renders the scene. Returns an RGB image of the camera's size. Throws phiz::Error(bad_input) for scenes, cameras or
/// options that are not valid (see validate(const Scene&)). An empty scene gives the backdrop.
///
/// Visibility (ambient occlusion and soft shadows) is traced once per pixel with a pattern that differs among 4 x 4
/// neighbours and is gathered over them where they lie on the same surface; materials are shaded at every lens sample.
Image render(const Scene& scene, const Camera& camera, const RenderOptions& options = {});

}  // namespace phiz
