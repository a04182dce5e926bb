// SPDX-License-Identifier: GPL-3.0-or-later
/// What the anatomy is fitted to: points and surfaces measured on the face kit's neutral face.
#pragma once

#include <array>
#include <vector>

#include "phiz/anatomy/builtin/flesh_thickness.h"
#include "phiz/anatomy/open/sources.h"

namespace phiz {

struct FaceGuide {
  TriangleMesh outer_skin;             ///< face, head, neck and shoulders
  std::array<Vector3d, 68> landmarks;  ///< the usual markup
  std::array<Vector3d, 28> crowns;     ///< centres of the crowns, in the order of face_kit::teeth
  Vector3d left_eye, right_eye;        ///< centres of the eyeballs
  double eye_radius = 0;               ///< metres
  Proportions proportions;             ///< the anthropometric points as this face has them
  std::vector<ThicknessSite> sites;    ///< thickness_sites(proportions), on this skin
};

/// Measures the face kit, in its own frame, metres. The anthropometric points that no landmark gives are carried over
/// from the built-in head by radial interpolation between landmarks of both, and put on the skin.
FaceGuide measure_face(const FaceKit& kit);

/// The part of a tooth that is within `height` of its far end: the crown. `up` is the direction from crown to root.
Vector3d crown_centre(const MatrixX3d& V, const Vector3d& up, double height = 0.006);

/// Centre and radius of the sphere that fits points best (linear least squares).
struct Sphere {
  Vector3d centre;
  double radius;
};
Sphere fit_sphere(const MatrixX3d& points);

/// Triangles of a range of the face kit's polygons over all its vertices.
MatrixX3i face_kit_triangles(const PolygonMesh& mesh, int first, int end);

}  // namespace phiz
