// SPDX-License-Identifier: GPL-3.0-or-later
/// Internal: what a point of a surface sends towards the camera. Included by sources only.
#pragma once

#include <array>
#include <vector>

#include "phiz/render/ray_scene.h"

namespace phiz::detail {

inline constexpr int max_lights = 6;

/// How much a point sees of its surroundings and of each light, in [0, 1].
struct Visibility {
  float ambient = 1;
  std::array<float, max_lights> light{};
};

struct ShadingLight {
  Vector3f position, irradiance, axis_u, axis_v;  // axes span the disc
  float radius = 0;
};

struct ShadingContext {
  const RayScene* rays = nullptr;
  std::vector<ShadingLight> lights;
  Vector3f sky, ground;
  float exposure = 1;
  int ambient_samples = 0, light_samples = 0;
  float ambient_reach = 0;  // world units
};

/// Traces visibility at a point. `pattern`, 0 to 255, selects the sample pattern.
Visibility trace_visibility(const ShadingContext& context, const ShadedPoint& point, int pattern);

/// Radiance towards the viewer (before the tone curve), linear RGB. `direction`: unit, from the viewer.
Vector3f radiance(const ShadingContext& context, const ShadedPoint& point, const Vector3f& direction,
                  const Visibility& visibility, float footprint);

/// The tone curve: the identity up to a shoulder, then a smooth approach to 1. And its inverse.
Vector3f tone_curve(const Vector3f& x);
Vector3f inverse_tone_curve(const Vector3f& y);

}  // namespace phiz::detail
