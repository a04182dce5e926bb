// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/open/kit_identity.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "phiz/anatomy/open/face_kit_layout.h"
#include "phiz/geometry/geodesic.h"
#include "phiz/geometry/surface.h"
#include "phiz/numerics/rbf.h"

namespace phiz {

IdentityModel kit_identity(const FaceKit& kit, const FaceKitSkin& skin) {
  const Eigen::Index n = skin.mesh.V.rows(), own = face_kit::skin_vertices.end;
  const auto modes = static_cast<Eigen::Index>(kit.identities.size());

  std::vector<char> lining(static_cast<std::size_t>(n), 0);
  for (const char* name : {"mouthBag", "leftSocket", "rightSocket"})
    for (const int v : skin.regions.at(name)) lining[static_cast<std::size_t>(v)] = 1;
  for (const auto* line : {&skin.lip_line, &skin.socket_lines[0], &skin.socket_lines[1]})
    for (const int v : *line) lining[static_cast<std::size_t>(v)] = 0;
  std::vector<int> inner, outer;
  for (int v = 0; v < own; ++v) (lining[static_cast<std::size_t>(v)] != 0 ? inner : outer).push_back(v);

  // Samples of the outer skin, and all of it near the lines where the lining begins: lids are thin.
  constexpr Eigen::Index samples = 900;
  constexpr double beside = 0.006;
  std::vector<int> centres;
  for (const int i : farthest_points(skin.mesh.V(outer, Eigen::all), samples))
    centres.push_back(outer[static_cast<std::size_t>(i)]);
  for (const auto* line : {&skin.lip_line, &skin.socket_lines[0], &skin.socket_lines[1]}) {
    const VectorXd distance = edge_distances(skin.mesh.V, skin.mesh.F, *line);
    for (const int v : outer)
      if (distance[v] < beside) centres.push_back(v);
  }
  std::sort(centres.begin(), centres.end());
  centres.erase(std::unique(centres.begin(), centres.end()), centres.end());

  MatrixXd values(static_cast<Eigen::Index>(centres.size()), 3 * modes);
  for (Eigen::Index k = 0; k < modes; ++k)
    values.middleCols<3>(3 * k) = kit.identities[static_cast<std::size_t>(k)](centres, Eigen::all);
  const MatrixXd of_lining = Rbf(skin.mesh.V(centres, Eigen::all), values).evaluate(skin.mesh.V(inner, Eigen::all));

  IdentityModel model;
  model.skin.resize(3 * n, modes);
  model.deviation.resize(modes);
  for (Eigen::Index k = 0; k < modes; ++k) {
    MatrixX3d mode = kit.identities[static_cast<std::size_t>(k)].topRows(own);
    mode(inner, Eigen::all) = of_lining.middleCols<3>(3 * k);
    const MatrixX3d all = with_cap(skin, mode);
    model.skin.col(k) = all.cast<float>().reshaped<Eigen::RowMajor>();
    model.deviation[k] = std::sqrt(all.squaredNorm() / static_cast<double>(n));
  }
  return model;
}

}  // namespace phiz
