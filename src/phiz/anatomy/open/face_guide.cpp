// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/open/face_guide.h"

#include <Eigen/QR>
#include <cmath>
#include <utility>

#include "phiz/anatomy/builtin/skin/surface.h"
#include "phiz/anatomy/open/face_kit_layout.h"
#include "phiz/core/error.h"
#include "phiz/geometry/spatial_query.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/topology.h"
#include "phiz/numerics/rbf.h"

namespace phiz {

namespace {

/// Points that both heads have: landmarks, and the ends of the vault along the axes. `V` are the points of the outer
/// skin, `eye` the left eye's centre.
MatrixX3d common_points(const MatrixX3d& V, const std::vector<Vector3d>& landmarks, const Vector3d& eye) {
  const auto farthest = [&V](const Vector3d& direction, auto&& where) {
    Eigen::Index best = -1;
    for (Eigen::Index v = 0; v < V.rows(); ++v)
      if (where(V.row(v)) && (best < 0 || V.row(v).dot(direction) > V.row(best).dot(direction))) best = v;
    return Vector3d(V.row(best));
  };
  const double width = 0.012, above_ears = eye.y() + 0.035;
  const auto midline = [&](const auto& p) { return std::abs(p.x()) < width && p.y() > eye.y(); };
  const auto vault = [&](const auto& p) { return p.y() > above_ears; };
  std::vector<Vector3d> all = landmarks;
  for (const Vector3d& direction : {Vector3d(0, 1, 0), Vector3d(0, 0, -1)}) {
    Vector3d p = farthest(direction, midline);
    p.x() = 0;
    all.push_back(p);
  }
  for (const double side : {1.0, -1.0}) all.push_back(farthest(Vector3d(side, 0, 0), vault));
  MatrixX3d points(static_cast<Eigen::Index>(all.size()), 3);
  for (std::size_t i = 0; i < all.size(); ++i) points.row(static_cast<Eigen::Index>(i)) = all[i];
  return points;
}

/// Points of the mean built-in head in the order of common_points.
MatrixX3d builtin_points(const Proportions& p) {
  const SkinSurface skin = build_skin(p, {});
  const RefinedSkin refined = refine(skin, 1);
  std::vector<Vector3d> landmarks(face_kit::landmarks.size());
  for (const Landmark& mark : skin.landmarks)
    for (std::size_t i = 0; i < landmarks.size(); ++i)
      if (mark.name == std::to_string(i)) landmarks[i] = refined.mesh.V.row(mark.skin_vertex);
  return common_points(refined.mesh.V, landmarks, p.eye_centre);
}

/// Carries every point of `from` over.
Proportions carried_over(const Proportions& from, const Rbf& displacement, const SurfaceQuery& skin) {
  Proportions p = from;
  const auto move = [&](const Vector3d& q) { return Vector3d(q + displacement(q)); };
  const auto on_skin = [&](const Vector3d& q) { return skin.closest_point(move(q)).position; };
  for (Vector2d Proportions::*point :
       {&Proportions::vertex, &Proportions::opisthocranion, &Proportions::trichion, &Proportions::glabella,
        &Proportions::nasion, &Proportions::pronasale, &Proportions::subnasale, &Proportions::labrale_superius,
        &Proportions::stomion, &Proportions::labrale_inferius, &Proportions::sublabiale, &Proportions::pogonion,
        &Proportions::menton})
    p.*point = on_skin({0, (from.*point).x(), (from.*point).y()}).tail<2>();
  for (Vector3d Proportions::*point :
       {&Proportions::endocanthion, &Proportions::exocanthion, &Proportions::alare, &Proportions::cheilion,
        &Proportions::zygion, &Proportions::gonion, &Proportions::tragion, &Proportions::euryon})
    p.*point = on_skin(from.*point);
  p.condyle = move(from.condyle);
  return p;
}

}  // namespace

MatrixX3i face_kit_triangles(const PolygonMesh& mesh, int first, int end) {
  PolygonMesh part;
  part.V = mesh.V;
  part.faces.assign(mesh.faces.begin() + first, mesh.faces.begin() + end);
  return triangulate(part).F;
}

Vector3d crown_centre(const MatrixX3d& V, const Vector3d& up, double height) {
  const VectorXd along = V * up;
  const double low = along.minCoeff();
  Vector3d sum = Vector3d::Zero();
  int count = 0;
  for (Eigen::Index v = 0; v < V.rows(); ++v)
    if (along[v] < low + height) sum += V.row(v).transpose(), ++count;
  return sum / count;
}

Sphere fit_sphere(const MatrixX3d& points) {
  // |p|^2 = 2 c.p + (r^2 - |c|^2), linear in the unknowns.
  MatrixXd A(points.rows(), 4);
  A << 2 * points, VectorXd::Ones(points.rows());
  const Eigen::Vector4d x = A.colPivHouseholderQr().solve(points.rowwise().squaredNorm());
  return {x.head<3>(), std::sqrt(x[3] + x.head<3>().squaredNorm())};
}

FaceGuide measure_face(const FaceKit& kit) {
  const MatrixX3d& V = kit.neutral.V;
  if (V.rows() != face_kit::vertex_count || static_cast<int>(kit.neutral.faces.size()) != face_kit::face_count)
    reject("generic_neutral_mesh.obj",
           "has " + std::to_string(V.rows()) + " vertices and " + std::to_string(kit.neutral.faces.size()) +
               " faces, expected 26719 and 26384",
           "use ICT Face Model Light as it is given out");
  constexpr face_kit::Range lower = face_kit::lower_teeth_vertices;
  constexpr double least_opening = 0.005;  // metres
  if (!(kit.expressions.at("jawOpen").middleRows(lower.first, lower.end - lower.first).rowwise().norm().minCoeff() >
        least_opening))
    reject("jawOpen.obj", "does not lower the lower teeth", "use ICT Face Model Light as it is given out");
  FaceGuide guide;
  guide.outer_skin =
      remove_unused_vertices(V, face_kit_triangles(kit.neutral, face_kit::outer_faces.first, face_kit::outer_faces.end))
          .mesh;
  std::vector<Vector3d> landmarks;
  for (std::size_t i = 0; i < guide.landmarks.size(); ++i) {
    guide.landmarks[i] = V.row(face_kit::landmarks[i]);
    landmarks.emplace_back(V.row(i < face_kit::jaw_line.size() ? face_kit::jaw_line[i] : face_kit::landmarks[i]));
  }
  for (std::size_t i = 0; i < guide.crowns.size(); ++i) {
    const face_kit::Tooth& tooth = face_kit::teeth[i];
    guide.crowns[i] = crown_centre(V.middleRows(tooth.vertices.first, tooth.vertices.end - tooth.vertices.first),
                                   tooth.upper ? Vector3d::UnitY() : Vector3d(-Vector3d::UnitY()));
  }
  const auto eye = [&V](const face_kit::Range& range) {
    return fit_sphere(V.middleRows(range.first, range.end - range.first));
  };
  const Sphere left = eye(face_kit::left_sclera_vertices), right = eye(face_kit::right_sclera_vertices);
  guide.left_eye = left.centre;
  guide.right_eye = right.centre;
  guide.eye_radius = 0.5 * (left.radius + right.radius);

  const Proportions mean;
  const MatrixX3d from = builtin_points(mean);
  const MatrixX3d to = common_points(guide.outer_skin.V, landmarks, guide.left_eye);
  guide.proportions =
      carried_over(mean, Rbf(from, to - from, RbfKernel::biharmonic, 0.01), SurfaceQuery(guide.outer_skin));
  guide.proportions.eye_centre = guide.left_eye;
  guide.proportions.eye_radius = guide.eye_radius;
  // Sites are placed in a head whose origin is midway between the condyles.
  const Vector3d condyles(0, guide.proportions.condyle.y(), guide.proportions.condyle.z());
  guide.sites = thickness_sites(translated(guide.proportions, -condyles));
  const SurfaceQuery skin(guide.outer_skin);
  for (ThicknessSite& site : guide.sites) site.skin = skin.closest_point(site.skin + condyles).position;
  return guide;
}

}  // namespace phiz
