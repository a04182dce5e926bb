// SPDX-License-Identifier: GPL-3.0-or-later
/// Internal: the scene in world space and single precision with its ray structure. Included by sources only.
#pragma once

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "phiz/render/scene.h"

namespace phiz::detail {

using Eigen::Vector3f;

struct Hit {
  int surface = -1;  ///< -1: nothing
  int triangle = -1;
  float u = 0, v = 0, distance = 0;
  explicit operator bool() const { return surface >= 0; }
};

/// A surface ready to be traced and shaded.
struct TracedSurface {
  std::vector<Eigen::Vector4f> position;  // padded to 16 bytes as Embree wants
  std::vector<Vector3f> normal, colour, rest, fibre;
  std::vector<Eigen::Matrix<unsigned, 3, 1>> triangle;
  Eigen::Matrix3f rotation = Eigen::Matrix3f::Identity();  // world from rest
  std::function<Vector3d(const Vector3d&)> colour_at;
  Material material;
  Wireframe wireframe;
  bool flat = false;
  float outline = 0;
};

/// A point on a surface as seen along a ray.
struct ShadedPoint {
  const TracedSurface* surface = nullptr;
  Vector3f position, normal, face_normal;  // normals face the viewer
  Vector3f smooth_position;                // on the curved surface that the normals suggest: origin of secondary rays
  Vector3f colour, rest;
  Vector3f fibre = Vector3f::Zero();  // in the frame of `rest`
  int triangle = -1;
  float u = 0, v = 0;
};

class RayScene {
 public:
  RayScene(const Scene& scene, bool fast_build);

  Hit first_hit(const Vector3f& origin, const Vector3f& direction, float near) const;
  /// Any opaque surface between the ends?
  bool occluded(const Vector3f& origin, const Vector3f& direction, float near, float far) const;
  ShadedPoint point(const Hit& hit, const Vector3f& direction) const;
  /// Length of the bounding box's diagonal; 1 for an empty scene.
  float size() const { return size_; }
  const std::vector<TracedSurface>& surfaces() const { return surfaces_; }

 private:
  struct Release {
    void operator()(RTCSceneTy* s) const { rtcReleaseScene(s); }
    void operator()(RTCDeviceTy* d) const { rtcReleaseDevice(d); }
  };
  std::vector<TracedSurface> surfaces_;
  std::unique_ptr<RTCDeviceTy, Release> device_;
  std::unique_ptr<RTCSceneTy, Release> all_, opaque_;
  float size_ = 1;
};

}  // namespace phiz::detail
