// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/render/shading.h"

#include <algorithm>
#include <cmath>

#include "phiz/render/sampling.h"

namespace phiz::detail {

namespace {

constexpr float pi = 3.14159265F;

Vector3f mix(const Vector3f& a, const Vector3f& b, float t) {
  return a + (b - a) * t;
}

Vector3f ambient_radiance(const ShadingContext& c, const Vector3f& direction) {
  return mix(c.ground, c.sky, 0.5F + 0.5F * direction.y());
}

/// Multiple bounces brighten the ambient occlusion of bright surfaces (Jimenez et al. 2016, per channel).
Vector3f bounced(float visibility, const Vector3f& albedo) {
  Vector3f out;
  for (int k = 0; k < 3; ++k) {
    const float a = 2.0404F * albedo[k] - 0.3324F;
    const float b = -4.7951F * albedo[k] + 0.6417F;
    const float c = 2.7552F * albedo[k] + 0.6903F;
    out[k] = std::max(visibility, ((visibility * a + b) * visibility + c) * visibility);
  }
  return out;
}

/// Reflectance of the ambient light by a rough surface (Lazarov 2013, analytic fit).
float ambient_reflectance(float specular, float roughness, float cosine) {
  const float rx = 1 - roughness, ry = 0.0425F - 0.0275F * roughness;
  const float rz = 1.04F - 0.572F * roughness, rw = -0.04F + 0.022F * roughness;
  const float a = std::min(rx * rx, std::exp2(-9.28F * cosine)) * rx + ry;
  return std::max(0.F, specular * (-1.04F * a + rz) + 1.04F * a + rw);
}

float fresnel(float specular, float cosine) {
  const float m = std::clamp(1 - cosine, 0.F, 1.F);
  return specular + (1 - specular) * m * m * m * m * m;
}

/// GGX highlight of a disc light of angular radius `spread` (sine), without the irradiance.
float highlight(const Vector3f& n, const Vector3f& view, const Vector3f& l, const Material& m, float spread) {
  const float nl = n.dot(l), nv = std::max(1e-3F, n.dot(view));
  if (nl <= 0) return 0;
  const Vector3f h = (l + view).normalized();
  const float f = fresnel(static_cast<float>(m.specular), view.dot(h));
  const float roughness = static_cast<float>(m.roughness);
  if (roughness < 0.15F) {  // sharp: the mirror image of the disc
    const Vector3f mirrored = 2 * n.dot(view) * n - view;
    const float sine = mirrored.cross(l).norm();
    const float blur = 0.03F + roughness * roughness;
    const float t = std::clamp((spread + blur - sine) / (2 * blur), 0.F, 1.F);
    return mirrored.dot(l) > 0 ? f * t * t * (3 - 2 * t) / (pi * spread * spread) : 0.F;
  }
  const float alpha2 = std::pow(roughness, 4.F) + 0.25F * spread * spread;
  const float nh = std::max(0.F, n.dot(h));
  const float d = nh * nh * (alpha2 - 1) + 1;
  const float lambda_v = nl * std::sqrt(nv * nv * (1 - alpha2) + alpha2);
  const float lambda_l = nv * std::sqrt(nl * nl * (1 - alpha2) + alpha2);
  return f * nl * alpha2 / (pi * d * d) * 0.5F / std::max(1e-6F, lambda_v + lambda_l);
}

}  // namespace

Visibility trace_visibility(const ShadingContext& c, const ShadedPoint& p, int pattern) {
  Visibility seen;
  const float step = 1e-4F * c.rays->size();
  const Vector3f origin = p.smooth_position + p.face_normal * step;
  if (c.ambient_samples > 0) {
    const Vector3f t1 = p.normal.unitOrthogonal(), t2 = p.normal.cross(t1);
    int open = 0;
    for (int j = 0; j < c.ambient_samples; ++j) {
      const Sample2 s = plane_sample(j, c.ambient_samples, pattern);
      const float r = std::sqrt(s.x), phi = 2 * pi * s.y;
      Vector3f d = t1 * (r * std::cos(phi)) + t2 * (r * std::sin(phi)) + p.normal * std::sqrt(1 - s.x);
      const float below = d.dot(p.face_normal);
      if (below < 0) d -= 2 * below * p.face_normal;
      // Rays of random length make occlusion fade out with distance.
      const float length = c.ambient_reach * std::sqrt(line_sample(j, c.ambient_samples, pattern));
      if (!c.rays->occluded(origin, d, step, std::max(length, 2 * step))) ++open;
    }
    seen.ambient = static_cast<float>(open) / static_cast<float>(c.ambient_samples);
  }
  // Light that enters skin a little away from the point reaches it: lift the origin of its shadow rays.
  const float lift = 0.006F * c.rays->size() * static_cast<float>(p.surface->material.scatter[0]);
  const Vector3f lit_origin = origin + p.normal * lift;
  const float wrap = static_cast<float>(p.surface->material.scatter.maxCoeff());
  for (std::size_t i = 0; i < c.lights.size(); ++i) {
    const ShadingLight& light = c.lights[i];
    if (c.light_samples <= 0) {
      seen.light[i] = 1;
      continue;
    }
    const Vector3f centre = light.position - lit_origin;
    if (p.normal.dot(centre) < -(wrap + 0.02F) * centre.norm() - light.radius) continue;
    int open = 0;
    for (int j = 0; j < c.light_samples; ++j) {
      const Sample2 s = plane_sample(j, c.light_samples, pattern);
      const float r = light.radius * std::sqrt(s.x), phi = 2 * pi * s.y;
      const Vector3f to = centre + light.axis_u * (r * std::cos(phi)) + light.axis_v * (r * std::sin(phi));
      const float distance = to.norm();
      if (!c.rays->occluded(lit_origin, to / distance, step, distance)) ++open;
    }
    seen.light[i] = static_cast<float>(open) / static_cast<float>(c.light_samples);
  }
  return seen;
}

Vector3f radiance(const ShadingContext& c, const ShadedPoint& p, const Vector3f& direction, const Visibility& seen,
                  float footprint) {
  const Material& m = p.surface->material;
  const Vector3f view = -direction;
  Vector3f n = p.normal;
  if (m.grain > 0) {
    const Vector3f slope =
        p.surface->rotation * grain_slope(p.rest, static_cast<float>(m.grain), c.rays->size(), footprint);
    n = (n - (slope - n * n.dot(slope))).normalized();
  }
  Vector3f albedo = m.albedo.cast<float>().cwiseProduct(p.colour);
  if (const float length = p.fibre.norm(); length > 0.1F) {
    const float strength = static_cast<float>(m.striation);
    const Streak streak = fibre_streak(p.rest, p.fibre / length, c.rays->size(), footprint);
    const Vector3f slope = p.surface->rotation * (0.22F * strength * streak.slope);
    n = (n - (slope - n * n.dot(slope))).normalized();
    // Light streaks are connective tissue: paler, not only brighter.
    const float light = strength * streak.light;
    albedo = albedo.cwiseProduct(Vector3f(1 + 0.7F * light, 1 + 1.1F * light, 1 + 1.1F * light).cwiseMax(0.25F));
  }
  const Vector3f scatter = m.scatter.cast<float>();
  const float nv = std::clamp(n.dot(view), 0.F, 1.F);
  const float shine = ambient_reflectance(static_cast<float>(m.specular), static_cast<float>(m.roughness), nv);

  Vector3f diffuse = Vector3f::Zero();
  Vector3f glossy = Vector3f::Zero();
  for (std::size_t i = 0; i < c.lights.size(); ++i) {
    const ShadingLight& light = c.lights[i];
    const Vector3f to = light.position - p.position;
    const float distance = to.norm();
    const Vector3f l = to / distance;
    const float nl = n.dot(l), visible = seen.light[i];
    for (int k = 0; k < 3; ++k) {
      const float wrap = scatter[k];
      const float lambert = std::max(0.F, nl + wrap) / ((1 + wrap) * (1 + wrap));
      const float soft = visible + wrap * (std::sqrt(visible) - visible);  // penumbrae bleed, red most
      diffuse[k] += light.irradiance[k] * lambert * soft;
    }
    if (visible > 0) glossy += light.irradiance * (visible * highlight(n, view, l, m, light.radius / distance));
  }
  diffuse /= pi;
  // Light that has entered elsewhere brightens the depths of what scatters.
  const float ambient = seen.ambient + 0.4F * scatter.maxCoeff() * (1 - seen.ambient);
  const Vector3f occlusion = bounced(ambient, albedo);
  diffuse += ambient_radiance(c, n).cwiseProduct(occlusion);
  const Vector3f mirrored = 2 * n.dot(view) * n - view;
  const float gloss_visible = std::clamp(
      std::pow(nv + seen.ambient, std::exp2(-16 * static_cast<float>(m.roughness) - 1)) - 1 + seen.ambient, 0.F, 1.F);
  glossy += ambient_radiance(c, mirrored) * (shine * gloss_visible);
  const Vector3f lit = c.exposure * (diffuse.cwiseProduct(albedo) * (1 - shine) + glossy);
  const float unlit = static_cast<float>(m.unlit);
  return unlit > 0 ? mix(lit, inverse_tone_curve(albedo), unlit) : lit;
}

namespace {
constexpr float shoulder = 0.6F;
}

Vector3f tone_curve(const Vector3f& x) {
  return x.unaryExpr([](float v) {
    return v <= shoulder ? std::max(v, 0.F)
                         : shoulder + (1 - shoulder) * (1 - std::exp(-(v - shoulder) / (1 - shoulder)));
  });
}

Vector3f inverse_tone_curve(const Vector3f& y) {
  return y.unaryExpr([](float v) {
    const float w = std::min(v, 0.999F);
    return w <= shoulder ? w : shoulder - (1 - shoulder) * std::log(1 - (w - shoulder) / (1 - shoulder));
  });
}

}  // namespace phiz::detail
