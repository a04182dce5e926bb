// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/render/ray_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "phiz/core/error.h"

namespace phiz::detail {

namespace {

constexpr double farthest = 1e9;  // the ray tracer counts in floats

/// Angle-weighted vertex normals.
std::vector<Vector3f> vertex_normals(const TracedSurface& s) {
  std::vector<Vector3f> normal(s.position.size(), Vector3f::Zero());
  for (const auto& t : s.triangle) {
    for (int c = 0; c < 3; ++c) {
      const Vector3f p = s.position[t[c]].head<3>();
      const Vector3f a = s.position[t[(c + 1) % 3]].head<3>() - p, b = s.position[t[(c + 2) % 3]].head<3>() - p;
      const Vector3f cross = a.cross(b);
      const float length = cross.norm();
      if (length > 0) normal[t[c]] += cross / length * std::atan2(length, a.dot(b));
    }
  }
  for (Vector3f& n : normal) {
    const float length = n.norm();
    n = length > 0 ? Vector3f(n / length) : Vector3f::UnitZ();
  }
  return normal;
}

TracedSurface prepare(const Surface& surface) {
  TracedSurface s;
  const Eigen::Index n = surface.mesh.V.rows();
  s.position.resize(n + 1, Eigen::Vector4f::Zero());
  for (Eigen::Index i = 0; i < n; ++i) {
    const Vector3d position = surface.transform * Vector3d(surface.mesh.V.row(i));
    if (!(position.cwiseAbs().maxCoeff() <= farthest))
      reject(surface.name, fmt::format("vertex {} lies too far out to be drawn", i),
             fmt::format("coordinates must be within {:g}", farthest));
    s.position[i].head<3>() = position.cast<float>();
  }
  s.triangle.resize(surface.mesh.F.rows());
  for (Eigen::Index f = 0; f < surface.mesh.F.rows(); ++f)
    s.triangle[f] = surface.mesh.F.row(f).transpose().cast<unsigned>();
  if (surface.normals.rows() == n) {
    s.normal.resize(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Vector3d v = surface.transform.linear() * Vector3d(surface.normals.row(i));
      s.normal[i] = (v.norm() > 0 ? Vector3d(v.normalized()) : Vector3d::UnitZ()).cast<float>();
    }
  } else {
    s.normal = vertex_normals(s);
  }
  s.colour.resize(surface.colour.rows());
  for (Eigen::Index i = 0; i < surface.colour.rows(); ++i) s.colour[i] = surface.colour.row(i).cast<float>();
  if (surface.fibre.rows() == n && surface.material.striation > 0)
    for (Eigen::Index i = 0; i < n; ++i) s.fibre.emplace_back(surface.fibre.row(i).cast<float>());
  if (surface.material.grain > 0 || surface.colour_at || !s.fibre.empty()) {
    const MatrixX3d& rest = surface.rest.rows() == n ? surface.rest : surface.mesh.V;
    s.rest.resize(n);
    for (Eigen::Index i = 0; i < n; ++i) s.rest[i] = rest.row(i).cast<float>();
  }
  s.rotation = surface.transform.rotation().cast<float>();
  s.colour_at = surface.colour_at;
  s.material = surface.material;
  s.wireframe = surface.wireframe;
  s.flat = surface.flat;
  s.outline = static_cast<float>(surface.outline);
  return s;
}

RTCRayHit make_ray(const Vector3f& origin, const Vector3f& direction, float near, float far) {
  RTCRayHit r{};
  r.ray.org_x = origin.x();
  r.ray.org_y = origin.y();
  r.ray.org_z = origin.z();
  r.ray.dir_x = direction.x();
  r.ray.dir_y = direction.y();
  r.ray.dir_z = direction.z();
  r.ray.tnear = near;
  r.ray.tfar = far;
  r.ray.mask = ~0U;
  r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return r;
}

}  // namespace

RayScene::RayScene(const Scene& scene, bool fast_build) {
  const Eigen::AlignedBox3d box = bounding_box(scene);
  if (!box.isEmpty() && box.diagonal().norm() > 0) size_ = static_cast<float>(box.diagonal().norm());
  device_.reset(rtcNewDevice(nullptr));
  if (!device_) fail("the ray tracer could not be started", "check that Embree runs on this processor");
  const auto new_scene = [&] {
    RTCScene s = rtcNewScene(device_.get());
    rtcSetSceneFlags(s, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(s, fast_build ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM);
    return s;
  };
  all_.reset(new_scene());
  opaque_.reset(new_scene());
  surfaces_.reserve(scene.surfaces.size());
  for (const Surface& surface : scene.surfaces) {
    surfaces_.push_back(prepare(surface));
    const TracedSurface& s = surfaces_.back();
    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuildQuality(geometry, fast_build ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, s.position.data(), 0,
                               sizeof(Eigen::Vector4f), s.position.size() - 1);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, s.triangle.data(), 0,
                               3 * sizeof(unsigned), s.triangle.size());
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(all_.get(), geometry, static_cast<unsigned>(surfaces_.size() - 1));
    if (s.material.opacity >= 1) rtcAttachGeometry(opaque_.get(), geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(all_.get());
  rtcCommitScene(opaque_.get());
  if (rtcGetDeviceError(device_.get()) != RTC_ERROR_NONE)
    fail("the ray tracer could not take the scene", "free some memory or use a coarser mesh");
}

Hit RayScene::first_hit(const Vector3f& origin, const Vector3f& direction, float near) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  RTCRayHit r = make_ray(origin, direction, near, std::numeric_limits<float>::infinity());
  rtcIntersect1(all_.get(), &context, &r);
  Hit hit;
  if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;
  hit.surface = static_cast<int>(r.hit.geomID);
  hit.triangle = static_cast<int>(r.hit.primID);
  hit.u = r.hit.u;
  hit.v = r.hit.v;
  hit.distance = r.ray.tfar;
  return hit;
}

bool RayScene::occluded(const Vector3f& origin, const Vector3f& direction, float near, float far) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit r = make_ray(origin, direction, near, far);
  rtcOccluded1(opaque_.get(), &context, &r.ray);
  return r.ray.tfar < 0;
}

ShadedPoint RayScene::point(const Hit& hit, const Vector3f& direction) const {
  ShadedPoint p;
  const TracedSurface& s = surfaces_[hit.surface];
  const auto& t = s.triangle[hit.triangle];
  p.surface = &s;
  p.triangle = hit.triangle;
  p.u = hit.u;
  p.v = hit.v;
  const float w = 1 - hit.u - hit.v;
  const Vector3f a = s.position[t[0]].head<3>(), b = s.position[t[1]].head<3>(), c = s.position[t[2]].head<3>();
  p.position = w * a + hit.u * b + hit.v * c;
  p.face_normal = (b - a).cross(c - a).stableNormalized();
  const Vector3f &na = s.normal[t[0]], &nb = s.normal[t[1]], &nc = s.normal[t[2]];
  Vector3f n = w * na + hit.u * nb + hit.v * nc;
  const float length = n.norm();
  p.normal = s.flat || length < 1e-6F ? p.face_normal : Vector3f(n / length);
  p.smooth_position = p.position;
  const bool back = p.face_normal.dot(direction) > 0;
  if (!s.flat) {
    // Hanika 2021: shift to the tangent planes of the corners, on the visible side only.
    const float side = back ? -1.F : 1.F;
    const auto lift = [&](const Vector3f& corner, const Vector3f& corner_normal) -> Vector3f {
      const float below = std::min(0.F, side * (p.position - corner).dot(corner_normal));
      return -below * side * corner_normal;
    };
    p.smooth_position += w * lift(a, na) + hit.u * lift(b, nb) + hit.v * lift(c, nc);
  }
  if (p.face_normal.dot(p.normal) < 0) p.normal = -p.normal;  // inconsistent winding
  if (back) {
    p.face_normal = -p.face_normal;
    p.normal = -p.normal;
  }
  p.colour = s.colour.empty() ? Vector3f(1, 1, 1)
                              : Vector3f(w * s.colour[t[0]] + hit.u * s.colour[t[1]] + hit.v * s.colour[t[2]]);
  p.rest = s.rest.empty() ? p.position : Vector3f(w * s.rest[t[0]] + hit.u * s.rest[t[1]] + hit.v * s.rest[t[2]]);
  if (!s.fibre.empty()) p.fibre = w * s.fibre[t[0]] + hit.u * s.fibre[t[1]] + hit.v * s.fibre[t[2]];
  if (s.colour_at) p.colour = p.colour.cwiseProduct(s.colour_at(p.rest.cast<double>()).cast<float>());
  return p;
}

}  // namespace phiz::detail
