// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/expressions/contact.h"

#include <algorithm>
#include <set>

#include "phiz/anatomy/builtin/expressions/skin.h"
#include "phiz/geometry/spatial_query.h"
#include "phiz/geometry/surface.h"
#include "phiz/geometry/topology.h"

namespace phiz {
namespace {

constexpr double deepest = 0.003;  ///< what lies deeper is on the far side of a patch, metres
constexpr double facing = -0.5;    ///< greatest cosine between the normals of skin that touches
constexpr int rounds = 12;
constexpr int reach = 10;  ///< rings of neighbours that follow

}  // namespace

PatchContact::PatchContact(const HeadTemplate& head, const std::string& upper, const std::string& lower, double gap)
    : rest_(head.skin.V),
      gap_(gap),
      upper_(patch(head, skin_region(head, upper), skin_region(head, lower))),
      lower_(patch(head, skin_region(head, lower), skin_region(head, upper))) {
  const auto neighbours = vertex_neighbours(head.skin.F, static_cast<int>(rest_.rows()));
  std::set<int> patches(upper_.vertices.begin(), upper_.vertices.end()), near;
  patches.insert(lower_.vertices.begin(), lower_.vertices.end());
  near = patches;
  for (int ring = 0; ring < reach; ++ring) {
    const std::set<int> before = near;
    for (const int v : before) {
      const auto& around = neighbours[static_cast<std::size_t>(v)];
      near.insert(around.begin(), around.end());
    }
  }
  for (const int v : near) surroundings_.emplace_back(v, neighbours[static_cast<std::size_t>(v)]);
}

PatchContact::Patch PatchContact::patch(const HeadTemplate& head, const VectorXi& own, const VectorXi& other) const {
  std::vector<char> member(static_cast<std::size_t>(rest_.rows()), 0), shared = member, rim = member;
  std::vector<char> both = member;
  for (const int v : other) shared[static_cast<std::size_t>(v)] = both[static_cast<std::size_t>(v)] = 1;
  for (const int v : own) member[static_cast<std::size_t>(v)] = both[static_cast<std::size_t>(v)] = 1;
  Patch result;
  for (const int v : own)
    if (!shared[static_cast<std::size_t>(v)]) result.vertices.push_back(v);
  std::vector<int> faces;
  const auto inside = [&](const std::vector<char>& set, Eigen::Index f) {
    int count = 0;
    for (int k = 0; k < 3; ++k) count += set[static_cast<std::size_t>(head.skin.F(f, k))];
    return count;
  };
  for (int f = 0; f < head.skin.F.rows(); ++f) {
    if (inside(member, f) == 3) faces.push_back(f);
    if (inside(both, f) < 3)
      for (int k = 0; k < 3; ++k) rim[static_cast<std::size_t>(head.skin.F(f, k))] = 1;
  }
  result.triangles = head.skin.F(faces, Eigen::all);
  for (Eigen::Index f = 0; f < result.triangles.rows(); ++f) {
    bool interior = true;
    for (int k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(result.triangles(f, k));
      interior = interior && !rim[v];
    }
    result.interior.push_back(interior);
  }
  return result;
}

bool PatchContact::separate(const Patch& moving, const Patch& obstacle, const MatrixX3d& V,
                            MatrixX3d& correction) const {
  const SurfaceQuery query(V, obstacle.triangles);
  const MatrixX3d normals = vertex_normals(V, obstacle.triangles), own = vertex_normals(V, moving.triangles);
  bool touched = false;
  for (const int v : moving.vertices) {
    const Vector3d x = V.row(v);
    const auto hit = query.closest_point_within(x, deepest);
    if (!hit || !obstacle.interior[static_cast<std::size_t>(hit->triangle)]) continue;
    const auto corners = obstacle.triangles.row(hit->triangle);
    Vector3d normal = Vector3d::Zero();
    for (int k = 0; k < 3; ++k) normal += hit->barycentric[k] * normals.row(corners[k]).transpose();
    normal.normalize();
    const double height = (x - hit->position).dot(normal);
    if (height >= gap_ || own.row(v).dot(normal.transpose()) > facing) continue;
    const Vector3d half = 0.5 * (gap_ - height) * normal;
    const auto keep_larger = [&](int row, const Vector3d& c) {
      if (c.squaredNorm() > correction.row(row).squaredNorm()) correction.row(row) = c.transpose();
    };
    keep_larger(v, half);
    for (int k = 0; k < 3; ++k) keep_larger(corners[k], -half);
    touched = true;
  }
  return touched;
}

void PatchContact::keep_apart(MatrixX3d& displacement) const {
  for (int round = 0; round < rounds; ++round) {
    const MatrixX3d V = rest_ + displacement;
    MatrixX3d correction = MatrixX3d::Zero(V.rows(), 3);
    const bool upper = separate(upper_, lower_, V, correction), lower = separate(lower_, upper_, V, correction);
    if (!upper && !lower) return;
    std::vector<char> fixed(static_cast<std::size_t>(V.rows()), 0);
    for (Eigen::Index v = 0; v < V.rows(); ++v) fixed[static_cast<std::size_t>(v)] = !correction.row(v).isZero();
    for (int pass = 0; pass < reach; ++pass)
      for (const auto& [v, ring] : surroundings_) {
        if (fixed[static_cast<std::size_t>(v)]) continue;
        Vector3d sum = Vector3d::Zero();
        for (const int w : ring) sum += correction.row(w).transpose();
        correction.row(v) = (0.95 * sum / static_cast<double>(ring.size())).transpose();
      }
    displacement += correction;
  }
}

}  // namespace phiz
