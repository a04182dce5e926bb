// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/render/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "phiz/core/error.h"
#include "phiz/core/parallel.h"
#include "phiz/render/lens.h"
#include "phiz/render/lights.h"
#include "phiz/render/sampling.h"
#include "phiz/render/shading.h"
#include "phiz/render/wire.h"

namespace phiz {

namespace detail {
namespace {

/// What the ray through a pixel's centre saw: visibility to be shared with the neighbours on the same surface.
struct PixelRecord {
  const TracedSurface* surface = nullptr;
  Vector3f position, normal;
  Visibility seen;
};

constexpr int most_layers = 8;  // surfaces along a ray, all but the last translucent

struct Frame {
  const Camera& camera;
  const RenderOptions& options;
  const Surroundings& surroundings;
  const RayScene& rays;
  Lens lens;
  ShadingContext context;
  bool translucent = false;          // is there any surface to see through?
  bool outlines = false;             // does any surface have an outline?
  std::vector<PixelRecord> records;  // of the first opaque surface
  std::vector<PixelRecord> veils;    // of the first surface, where that is translucent
  float depth_low = 0, depth_high = 1;
};

Vector3f backdrop(const Frame& frame, float y) {
  const float t = std::clamp(y / static_cast<float>(frame.camera.height), 0.F, 1.F);
  const float s = t * t * (3 - 2 * t);
  return ((1 - s) * frame.surroundings.backdrop_top + s * frame.surroundings.backdrop_bottom).cast<float>();
}

/// Calls body(x, y) for every pixel, in parallel over tiles.
template <class Body>
void for_pixels(const Camera& camera, const Body& body) {
  constexpr int tile = 16;
  const int across = (camera.width + tile - 1) / tile, down = (camera.height + tile - 1) / tile;
  parallel_chunks(static_cast<std::ptrdiff_t>(across) * down, 1, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      const int x0 = static_cast<int>(i % across) * tile, y0 = static_cast<int>(i / across) * tile;
      for (int y = y0; y < std::min(y0 + tile, camera.height); ++y)
        for (int x = x0; x < std::min(x0 + tile, camera.width); ++x) body(x, y);
    }
  });
}

bool is_translucent(const ShadedPoint& point) {
  return point.surface->material.opacity < 1;
}

/// Where the next ray through the same pixel starts, behind a hit.
float behind(const Frame& frame, const Hit& hit) {
  return hit.distance + 1e-5F * frame.rays.size();
}

void record_visibility(Frame& frame) {
  const std::size_t count = static_cast<std::size_t>(frame.camera.width) * frame.camera.height;
  frame.records.resize(count);
  if (frame.translucent) frame.veils.resize(count);
  for_pixels(frame.camera, [&](int x, int y) {
    const Vector3f d = frame.lens.direction(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
    const std::size_t pixel = static_cast<std::size_t>(y) * frame.camera.width + x;
    float near = frame.lens.near / -d.dot(frame.lens.back);
    for (int layer = 0; layer < most_layers; ++layer) {
      const Hit hit = frame.rays.first_hit(frame.lens.eye, d, near);
      if (!hit) return;
      const ShadedPoint point = frame.rays.point(hit, d);
      const bool veil = is_translucent(point);
      if (layer == 0 || !veil)
        (veil ? frame.veils : frame.records)[pixel] = {point.surface, point.position, point.normal,
                                                       trace_visibility(frame.context, point, pixel_pattern(x, y))};
      if (!veil) return;
      near = behind(frame, hit);
    }
  });
}

/// Visibility at a point seen through pixel position (x, y): from the 4 x 4 records about it that lie on the same
/// surface, or traced where there are too few.
Visibility gather_visibility(const Frame& frame, const ShadedPoint& point, float x, float y, float footprint) {
  const int x0 = static_cast<int>(std::floor(x - 0.5F)) - 1, y0 = static_cast<int>(std::floor(y - 0.5F)) - 1;
  const std::vector<PixelRecord>& records = is_translucent(point) ? frame.veils : frame.records;
  Visibility sum;
  sum.ambient = 0;
  float total = 0;
  const float thickness = 2.5F * footprint;
  for (int j = std::max(y0, 0); j < std::min(y0 + 4, frame.camera.height); ++j) {
    for (int i = std::max(x0, 0); i < std::min(x0 + 4, frame.camera.width); ++i) {
      const PixelRecord& r = records[static_cast<std::size_t>(j) * frame.camera.width + i];
      if (r.surface != point.surface) continue;
      const float off = std::abs(point.normal.dot(r.position - point.position));
      const float alike = point.normal.dot(r.normal);
      if (off > thickness || alike < 0.75F) continue;
      const float w = (1 - off / thickness) * (alike - 0.7F) * (1 / 0.3F);
      total += w;
      sum.ambient += w * r.seen.ambient;
      for (std::size_t k = 0; k < frame.context.lights.size(); ++k) sum.light[k] += w * r.seen.light[k];
    }
  }
  if (total < 1.2F)
    return trace_visibility(frame.context, point, pixel_pattern(static_cast<int>(x * 4), static_cast<int>(y * 4)));
  sum.ambient /= total;
  for (float& l : sum.light) l /= total;
  return sum;
}

/// Display-linear colour of one surface point; `open`: take it to see all light.
Vector3f shade(const Frame& frame, const ShadedPoint& point, const Vector3f& direction, float x, float y, bool open) {
  const float depth = frame.lens.depth(point.position);
  if (frame.options.shading == Shading::normals) {
    const Vector3f& n = point.normal;
    return Vector3f(n.dot(frame.lens.right), n.dot(frame.lens.up), n.dot(frame.lens.back)) * 0.5F +
           Vector3f::Constant(0.5F);
  }
  if (frame.options.shading == Shading::depth)
    return Vector3f::Constant((frame.depth_high - depth) / (frame.depth_high - frame.depth_low));
  const float footprint = depth / frame.lens.focal;
  Visibility seen;
  seen.light.fill(1);
  if (!open) seen = gather_visibility(frame, point, x, y, footprint);
  Vector3f colour = tone_curve(radiance(frame.context, point, direction, seen, footprint));
  if (point.surface->wireframe.shown) {
    const float cover = wire_coverage(frame.lens, point, x, y);
    colour += cover * (point.surface->wireframe.colour.cast<float>() - colour);
  }
  return colour;
}

/// Display-linear colour along the ray through pixel position (x, y): translucent surfaces in front, then an opaque one
/// or the backdrop.
Vector3f trace(const Frame& frame, float x, float y) {
  const Vector3f d = frame.lens.direction(x, y);
  float near = frame.lens.near / -d.dot(frame.lens.back);
  Vector3f colour = Vector3f::Zero();
  float through = 1;
  for (int layer = 0; layer < most_layers; ++layer) {
    const Hit hit = frame.rays.first_hit(frame.lens.eye, d, near);
    if (!hit) break;
    const ShadedPoint point = frame.rays.point(hit, d);
    const float opacity = static_cast<float>(point.surface->material.opacity);
    const float facing = std::abs(point.normal.dot(d));
    const float cover = layer + 1 == most_layers ? 1.F : opacity + (1 - opacity) * std::pow(1 - facing, 3.F);
    colour += through * cover * shade(frame, point, d, x, y, layer > 0 && is_translucent(point));
    through *= 1 - cover;
    if (through < 1e-3F) return colour;
    near = behind(frame, hit);
  }
  return colour + through * backdrop(frame, y);
}

/// What is left of the light where the picture's pixel (x, y) lies on the line between two surfaces.
float outline(const Frame& frame, int x, int y) {
  const auto surface = [&](int i, int j) {
    i = std::clamp(i, 0, frame.camera.width - 1);
    j = std::clamp(j, 0, frame.camera.height - 1);
    return frame.records[static_cast<std::size_t>(j) * frame.camera.width + i].surface;
  };
  const TracedSurface* here = surface(x, y);
  float dark = 0;
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) {
      const TracedSurface* there = surface(x + i, y + j);
      if (there == here) continue;
      const float strength = std::max(here != nullptr ? here->outline : 0.F, there != nullptr ? there->outline : 0.F);
      dark += strength * (i == 0 || j == 0 ? 2.F : 1.F) / 12;
    }
  }
  return 1 - std::min(2 * dark, 1.F);
}

float srgb(float linear) {
  const float v = std::clamp(linear, 0.F, 1.F);
  return v <= 0.0031308F ? 12.92F * v : 1.055F * std::pow(v, 1 / 2.4F) - 0.055F;
}

std::uint8_t quantise(float value, int x, int y, int channel) {
  // Ordered dither of less than one step keeps the backdrop free of bands.
  const float dither = (static_cast<float>(pixel_pattern(x + channel, y + 2 * channel) & 15) + 0.5F) / 16 - 0.5F;
  return static_cast<std::uint8_t>(std::clamp(value * 255 + 0.5F + 0.9F * dither, 0.F, 255.F));
}

ShadingContext make_context(const Scene& scene, const Camera& camera, const RenderOptions& options,
                            const RayScene& rays) {
  ShadingContext context;
  context.rays = &rays;
  context.sky = scene.surroundings.sky.cast<float>();
  context.ground = scene.surroundings.ground.cast<float>();
  context.exposure = static_cast<float>(options.exposure);
  context.ambient_samples = options.ambient_samples;
  context.light_samples = options.light_samples;
  context.ambient_reach = static_cast<float>(options.ambient_reach) * rays.size();
  const Eigen::AlignedBox3d box = bounding_box(scene);
  const Vector3d centre = box.isEmpty() ? camera.target : Vector3d(box.center());
  for (const AreaLight& light : scene.lights.empty() ? studio_lights(camera, box) : scene.lights) {
    ShadingLight l;
    l.position = light.position.cast<float>();
    l.irradiance = light.irradiance.cast<float>();
    l.radius = static_cast<float>(light.radius);
    const Vector3f towards = (light.position - centre).stableNormalized().cast<float>();
    l.axis_u = towards.unitOrthogonal();
    l.axis_v = towards.cross(l.axis_u);
    context.lights.push_back(l);
  }
  return context;
}

void check(const RenderOptions& o, const Scene& scene) {
  const auto within = [](int value, int low, int high, const char* name) {
    if (value < low || value > high)
      reject("render options", fmt::format("{} is {}, outside {} to {}", name, value, low, high));
  };
  within(o.samples, 1, 256, "samples");
  within(o.ambient_samples, 0, 256, "ambient_samples");
  within(o.light_samples, 0, 256, "light_samples");
  if (!(o.ambient_reach > 0 && std::isfinite(o.ambient_reach)) || !(o.exposure > 0 && std::isfinite(o.exposure)))
    reject("render options", "ambient_reach and exposure must be positive numbers");
  if (scene.lights.size() > max_lights)
    reject("scene", fmt::format("it has {} lights", scene.lights.size()), fmt::format("use at most {}", max_lights));
}

}  // namespace
}  // namespace detail

RenderOptions film_options() {
  RenderOptions o;
  o.samples = 4;
  o.ambient_samples = 4;
  o.light_samples = 1;
  o.fast_build = true;
  return o;
}

RenderOptions still_options() {
  RenderOptions o;
  o.samples = 16;
  o.ambient_samples = 16;
  o.light_samples = 4;
  return o;
}

Image render(const Scene& scene, const Camera& camera, const RenderOptions& options) {
  using namespace detail;
  validate(scene);
  check(options, scene);
  const RayScene rays(scene, options.fast_build);
  Frame frame{
      camera, options, scene.surroundings, rays, Lens(camera), make_context(scene, camera, options, rays), false, false,
      {},     {}};
  frame.translucent = std::any_of(rays.surfaces().begin(), rays.surfaces().end(),
                                  [](const TracedSurface& s) { return s.material.opacity < 1; });
  if (options.shading == Shading::depth) {
    const MatrixX3d points = world_points(scene);
    const VectorXd depths = (camera.eye.transpose().replicate(points.rows(), 1) - points) * camera_axes(camera).col(2);
    if (points.rows() > 0) {
      frame.depth_low = static_cast<float>(depths.minCoeff());
      frame.depth_high = std::max(static_cast<float>(depths.maxCoeff()), frame.depth_low + 1e-6F);
    }
  }
  if (options.shading == Shading::lit) {
    record_visibility(frame);
    frame.outlines = std::any_of(rays.surfaces().begin(), rays.surfaces().end(),
                                 [](const TracedSurface& s) { return s.outline > 0; });
  }
  Image image{camera.width, camera.height, 3, {}};
  image.pixels.resize(static_cast<std::size_t>(camera.width) * camera.height * 3);
  const std::vector<Sample2> offsets = lens_offsets(options.samples);
  for_pixels(camera, [&](int x, int y) {
    Vector3f colour = Vector3f::Zero();
    for (const Sample2& o : offsets)
      colour += trace(frame, static_cast<float>(x) + 0.5F + o.x, static_cast<float>(y) + 0.5F + o.y);
    colour /= static_cast<float>(options.samples);
    if (frame.outlines) colour *= outline(frame, x, y);
    std::uint8_t* pixel = image.at(x, y);
    for (int k = 0; k < 3; ++k) pixel[k] = quantise(srgb(colour[k]), x, y, k);
  });
  return image;
}

}  // namespace phiz
