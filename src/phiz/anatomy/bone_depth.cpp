// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "phiz/anatomy/head_measures.h"
#include "phiz/anatomy/thickness_table.h"
#include "phiz/core/parallel.h"
#include "phiz/geometry/spatial_query.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/topology.h"

namespace phiz {
namespace {

constexpr int least_free = 3;  // directions; fewer: a look into a nostril
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Directions spread evenly over the sphere (Fibonacci).
std::array<Vector3d, 32> directions() {
  std::array<Vector3d, 32> all;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double z = 1 - (2.0 * static_cast<double>(i) + 1) / static_cast<double>(all.size());
    const double turn = std::numbers::pi * (3 - std::sqrt(5.0)) * static_cast<double>(i);
    all[i] = {std::sqrt(1 - z * z) * std::cos(turn), std::sqrt(1 - z * z) * std::sin(turn), z};
  }
  return all;
}

/// Least depth of the rows of `points` inside of a surface.
double least_depth(const SurfaceQuery& surface, const MatrixX3d& points) {
  return points.rows() == 0 ? infinity : -surface.signed_distances(points).maxCoeff();
}

}  // namespace

MatrixX3i outer_triangles(const HeadTemplate& head) {
  const TriangleMesh& skin = head.skin;
  std::vector<char> lining(static_cast<std::size_t>(skin.V.rows()), 0);
  for (const char* name : {"mouthBag", "leftSocket", "rightSocket"})
    if (const auto region = head.skin_regions.find(name); region != head.skin_regions.end())
      for (const int v : region->second) lining[static_cast<std::size_t>(v)] = 1;
  const SurfaceQuery query(skin);
  const MatrixX3d normals = triangle_normals(skin.V, skin.F);
  const auto ways = directions();
  std::vector<char> seen(static_cast<std::size_t>(skin.F.rows()), 0);
  parallel_for(skin.F.rows(), [&](std::ptrdiff_t f) {
    const auto lines = [&](int k) { return lining[static_cast<std::size_t>(skin.F(f, k))] != 0; };
    if (lines(0) && lines(1) && lines(2)) return;
    const Vector3d normal = normals.row(f);
    const Vector3d start = skin.V(skin.F.row(f), Eigen::all).colwise().mean().transpose() + 1e-5 * normal;
    const auto free = [&](const Vector3d& way) { return way.dot(normal) > 0.1 && !query.first_hit(start, way); };
    seen[static_cast<std::size_t>(f)] = std::count_if(ways.begin(), ways.end(), free) >= least_free ? 1 : 0;
  });
  std::vector<int> rows;
  for (std::size_t f = 0; f < seen.size(); ++f)
    if (seen[f]) rows.push_back(static_cast<int>(f));
  return skin.F(rows, Eigen::all);
}

TriangleMesh simulation_skin(const HeadTemplate& head, const MatrixX3d& displacement) {
  TriangleMesh skin{head.volume.V, head.skin_triangles, {}, {}};
  if (displacement.rows() == 0) return skin;
  const MatrixX3d moved = head.skin_sampling * displacement;
  for (Eigen::Index i = 0; i < head.skin_vertices.size(); ++i) skin.V.row(head.skin_vertices(i)) += moved.row(i);
  return skin;
}

double simulated_bone_depth(const HeadTemplate& head) {
  double least = infinity;
  const SurfaceQuery skin(simulation_skin(head));
  const MatrixX3d skin_points = head.volume.V(head.skin_vertices, Eigen::all);
  for (const int bone : {static_cast<int>(Tissue::skull), static_cast<int>(Tissue::mandible)}) {
    const MatrixX3i F = region_boundary(head.volume, bone);
    if (F.rows() == 0) continue;
    const TriangleMesh mesh = remove_unused_vertices(head.volume.V, F).mesh;
    least = std::min(least, least_depth(skin, mesh.V));
    least = std::min(least, SurfaceQuery(mesh).signed_distances(skin_points).minCoeff());
  }
  return least;
}

double drawn_bone_depth(const HeadTemplate& head) {
  const SurfaceQuery skin(head.skin.V, outer_triangles(head));
  double least = infinity;
  for (const char* name : {"skull", "mandible"})
    if (const Part* part = find_part(head, name)) least = std::min(least, least_depth(skin, part->mesh.V));
  return least;
}

std::vector<MeasuredThickness> measured_thickness(const HeadTemplate& head) {
  const SurfaceQuery skin(simulation_skin(head));
  std::vector<MeasuredThickness> all;
  for (const SkullLandmark& mark : head.skull_landmarks) {
    const UsualThickness* usual = find_usual_thickness(mark.name);
    if (usual == nullptr || !usual->published) continue;
    const auto hit = skin.first_hit(head.volume.V.row(mark.bone_vertex), mark.normal, 0, 0.06);
    all.push_back({mark.name, hit ? hit->t : std::numeric_limits<double>::quiet_NaN(), usual->mean, usual->deviation});
  }
  return all;
}

}  // namespace phiz
