// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/flesh_thickness.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "phiz/anatomy/thickness_table.h"
#include "phiz/geometry/spatial_query.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/topology.h"

namespace phiz {

std::vector<ThicknessSite> thickness_sites(const Proportions& p) {
  const double mm = 1e-3;
  const auto midline = [](const Vector2d& q) { return Vector3d(0, q.x(), q.y()); };
  const auto between = [](const Vector2d& a, const Vector2d& b, double t) { return Vector2d((1 - t) * a + t * b); };
  std::vector<ThicknessSite> sites{
      {"vertex", midline(p.vertex)},
      {"opisthocranion", midline(p.opisthocranion)},
      {"trichion", midline(p.trichion)},
      {"glabella", midline(p.glabella)},
      {"nasion", midline(p.nasion)},
      {"rhinion", midline(between(p.nasion, p.pronasale, 0.5))},
      {"subnasale", midline(p.subnasale)},
      {"pogonion", midline(p.pogonion)},
      {"gnathion", midline(between(p.pogonion, p.menton, 0.6))},
      {"menton", midline(p.menton)},
  };
  const Vector3d eye = p.eye_centre, outer = p.exocanthion, zyg = p.zygion, jaw = p.gonion;
  const Vector3d chin(0.022, p.menton.x() + 2 * mm, p.menton.y() - 10 * mm);
  const std::vector<ThicknessSite> left{
      {"frontalEminence", {0.030, p.trichion.x() - 10 * mm, p.trichion.y() - 4 * mm}},
      {"midSupraorbital", {eye.x(), p.glabella.x(), p.glabella.y() - 6 * mm}},
      {"midInfraorbital", {eye.x(), eye.y() - p.eye_radius - 8 * mm, eye.z() + 9 * mm}},
      {"alarCurvature", {p.alare.x() + 4 * mm, p.alare.y(), p.alare.z() - 8 * mm}},
      {"lateralOrbit", {outer.x() + 9 * mm, outer.y(), outer.z() - 8 * mm}},
      {"temple", {0.93 * zyg.x(), eye.y() + 18 * mm, zyg.z()}},
      {"zygion", zyg},
      {"euryon", p.euryon},
      {"midRamus", {1.12 * jaw.x(), 0.5 * jaw.y(), jaw.z() + 8 * mm}},
      {"gonion", jaw},
      {"midMandibularBorder", 0.5 * (jaw + chin)},
  };
  for (const ThicknessSite& site : left) {
    sites.push_back({site.name + "Left", site.skin});
    sites.push_back({site.name + "Right", {-site.skin.x(), site.skin.y(), site.skin.z()}});
  }
  for (ThicknessSite& site : sites) {
    const UsualThickness* usual = find_usual_thickness(site.name);
    site.thickness = usual->mean;
    site.deviation = usual->deviation;
    site.on_mandible = usual->on_mandible;
  }
  return sites;
}

double ThicknessField::operator()(const Vector3d& p) const {
  double sum = 0, weights = 0;
  for (const ThicknessSite& site : sites_) {
    const double square = (p - site.skin).squaredNorm() + 1e-6;
    const double weight = 1 / (square * square);
    sum += weight * site.thickness;
    weights += weight;
  }
  return sum / weights;
}

std::vector<SkullLandmark> find_skull_landmarks(const HeadTemplate& head, const Proportions& proportions) {
  const TriangleMesh skin{head.volume.V, head.skin_triangles, {}, {}};
  const SurfaceQuery skin_query(skin);
  const MatrixX3d skin_normals = vertex_normals(skin.V, skin.F);
  const MatrixX3i skull = region_boundary(head.volume, Tissue::skull);
  const MatrixX3i mandible = region_boundary(head.volume, Tissue::mandible);
  const MatrixX3d skull_normals = vertex_normals(head.volume.V, skull);
  const MatrixX3d mandible_normals = vertex_normals(head.volume.V, mandible);
  std::vector<SkullLandmark> landmarks;
  for (const ThicknessSite& site : thickness_sites(proportions)) {
    const SurfacePoint above = skin_query.closest_point(site.skin);
    Vector3d outward = Vector3d::Zero();
    for (int k = 0; k < 3; ++k)
      outward += above.barycentric(k) * skin_normals.row(skin.F(above.triangle, k)).transpose();
    outward.normalize();
    const Vector3d expected = above.position - site.thickness * outward;
    // The bone vertex that is near the expected place and under the site: from it one comes out of the skin close by.
    const MatrixX3i& F = site.on_mandible ? mandible : skull;
    const MatrixX3d& normals = site.on_mandible ? mandible_normals : skull_normals;
    SkullLandmark landmark;
    landmark.name = site.name;
    std::optional<RayHit> hit;
    double least = std::numeric_limits<double>::max();
    for (Eigen::Index f = 0; f < F.rows(); ++f) {
      for (int k = 0; k < 3; ++k) {
        const int v = F(f, k);
        const Vector3d bone = head.volume.V.row(v);
        const double facing = normals.row(v).dot(outward), near = (bone - expected).norm() * (2 - facing);
        if (facing <= 0.3 || near >= least) continue;
        // A corner of a coarse bone has no normal worth the name: halfway to that of the skin.
        const Vector3d normal = (normals.row(v).transpose() + outward).normalized();
        const auto out = skin_query.first_hit(bone, normal, 0, 0.05);
        if (!out || out->t > site.thickness + 3 * site.deviation) continue;
        const double cost = near + (bone + out->t * normal - above.position).norm();
        if (cost >= least) continue;
        least = cost;
        hit = out;
        landmark.bone_vertex = v;
        landmark.normal = normal;
      }
    }
    if (!hit) continue;
    landmark.thickness_mean = hit->t;
    landmark.thickness_deviation = std::max(0.0015, 0.3 * hit->t);
    Eigen::Index corner = 0;
    hit->barycentric.maxCoeff(&corner);
    // Vertices of the simulation skin come first in the volume; the drawn vertex that has most to do with it.
    double most = 0;
    for (SparseMatrixd::InnerIterator it(head.skin_sampling, skin.F(hit->triangle, corner)); it; ++it)
      if (it.value() > most) most = it.value(), landmark.skin_vertex = static_cast<int>(it.col());
    landmarks.push_back(landmark);
  }
  return landmarks;
}

}  // namespace phiz
