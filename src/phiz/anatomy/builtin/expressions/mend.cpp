// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/expressions/mend.h"

#include <algorithm>
#include <set>

#include "phiz/geometry/surface.h"
#include "phiz/geometry/topology.h"

namespace phiz {
namespace {

/// Cosine between every triangle and the mean normal of its corners: negative where it is folded over.
VectorXd uprightness(const MatrixX3d& V, const MatrixX3i& F) {
  const MatrixX3d faces = triangle_area_normals(V, F), normals = vertex_normals(V, F);
  VectorXd cosine(F.rows());
  for (Eigen::Index f = 0; f < F.rows(); ++f) {
    const Vector3d around = (normals.row(F(f, 0)) + normals.row(F(f, 1)) + normals.row(F(f, 2))).transpose();
    cosine[f] = faces.row(f).dot(around.transpose()) / std::max(faces.row(f).norm() * around.norm(), 1e-30);
  }
  return cosine;
}

void widen(std::set<int>& vertices, const std::vector<std::vector<int>>& neighbours, const std::vector<char>& kept) {
  const std::set<int> inner = vertices;
  for (const int v : inner)
    for (const int w : neighbours[static_cast<std::size_t>(v)])
      if (kept.empty() || !kept[static_cast<std::size_t>(w)]) vertices.insert(w);
}

/// Half the way to the mean of the neighbours.
void smooth_at(const std::set<int>& vertices, const std::vector<std::vector<int>>& neighbours, MatrixX3d& D) {
  const MatrixX3d before = D;
  for (const int v : vertices) {
    const MatrixX3d others = before(neighbours[static_cast<std::size_t>(v)], Eigen::all);
    D.row(v) = 0.5 * before.row(v) + 0.5 * others.colwise().mean();
  }
}

}  // namespace

SkinMender::SkinMender(const HeadTemplate& head)
    : skin_(head.skin),
      at_rest_(uprightness(skin_.V, skin_.F)),
      neighbours_(vertex_neighbours(skin_.F, static_cast<int>(skin_.V.rows()))) {
  std::vector<char> inside(static_cast<std::size_t>(skin_.V.rows()), 0);
  for (const char* name : {"upperLip", "lowerLip", "upperLipInner", "lowerLipInner", "mouthBag"})
    if (const auto found = head.skin_regions.find(name); found != head.skin_regions.end())
      for (const int v : found->second) inside[static_cast<std::size_t>(v)] = 1;
  for (int f = 0; f < skin_.F.rows(); ++f)
    for (int k = 0; k < 3; ++k)
      if (inside[static_cast<std::size_t>(skin_.F(f, k))]) {
        mouth_.push_back(f);
        break;
      }
}

void SkinMender::mend_folds(const std::vector<char>& kept, MatrixX3d& displacement) const {
  for (int round = 0; round < 40; ++round) {
    const VectorXd now = uprightness(skin_.V + displacement, skin_.F);
    std::set<int> touched;
    for (Eigen::Index f = 0; f < skin_.F.rows(); ++f) {
      if (now[f] >= (at_rest_[f] > 0.4 ? 0.15 : 0.0)) continue;
      for (int k = 0; k < 3; ++k)
        if (!kept[static_cast<std::size_t>(skin_.F(f, k))]) touched.insert(skin_.F(f, k));
    }
    if (touched.empty()) return;
    for (int ring = 0; ring <= round / 10; ++ring) widen(touched, neighbours_, kept);
    smooth_at(touched, neighbours_, displacement);
  }
}

void SkinMender::mend_crossings_in_the_mouth(MatrixX3d& displacement) const {
  TriangleMesh mouth;
  mouth.F = skin_.F(mouth_, Eigen::all);
  MatrixX3d best = displacement;
  std::size_t fewest = 0;
  for (int round = 0; round <= 12; ++round) {
    mouth.V = skin_.V + displacement;
    const auto pairs = self_intersections(mouth);
    if (round == 0 || pairs.size() < fewest) {
      best = displacement;
      fewest = pairs.size();
    }
    if (fewest == 0) break;
    std::set<int> touched;
    for (const auto& [a, b] : pairs)
      for (int k = 0; k < 3; ++k) touched.insert({mouth.F(a, k), mouth.F(b, k)});
    for (int ring = 0; ring <= round / 4; ++ring) widen(touched, neighbours_, {});
    smooth_at(touched, neighbours_, displacement);
  }
  displacement = best;
}

}  // namespace phiz
