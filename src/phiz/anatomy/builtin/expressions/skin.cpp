// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/builtin/expressions/skin.h"

#include "phiz/core/error.h"

namespace phiz {

const VectorXi& skin_region(const HeadTemplate& head, const std::string& name) {
  const auto found = head.skin_regions.find(name);
  if (found == head.skin_regions.end() || found->second.size() < 3)
    reject(head.name, "the skin region '" + name + "' is missing or has fewer than 3 vertices",
           "expressions need the regions of lips, lids and brows");
  return found->second;
}

MatrixX3d skin_curve(const HeadTemplate& head, const std::string& region) {
  const VectorXi& vertices = skin_region(head, region);
  MatrixX3d curve(vertices.size(), 3);
  for (Eigen::Index i = 0; i < curve.rows(); ++i) curve.row(i) = head.skin.V.row(vertices[i]);
  return curve;
}

std::vector<char> simulation_mask(const HeadTemplate& head, const std::vector<std::string>& regions) {
  std::vector<char> drawn(static_cast<std::size_t>(head.skin.V.rows()), 0);
  for (const std::string& name : regions)
    if (const auto found = head.skin_regions.find(name); found != head.skin_regions.end())
      for (const int v : found->second) drawn[static_cast<std::size_t>(v)] = 1;
  std::vector<char> mask(static_cast<std::size_t>(head.skin_vertices.size()), 0);
  for (Eigen::Index i = 0; i < head.skin_sampling.rows(); ++i) {
    Eigen::Index main = 0;
    double most = -1;
    for (SparseMatrixd::InnerIterator it(head.skin_sampling, i); it; ++it)
      if (it.value() > most) {
        most = it.value();
        main = it.col();
      }
    mask[static_cast<std::size_t>(i)] = drawn[static_cast<std::size_t>(main)];
  }
  return mask;
}

}  // namespace phiz
