// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/face/drawn_skin.h"

#include "phiz/core/parallel.h"

namespace phiz {

DrawnSkin::DrawnSkin(const HeadTemplate& head)
    : rest_(head.skin.V),
      simulated_(head.skin_vertices),
      simulated_rest_(head.volume.V(head.skin_vertices, Eigen::all)) {
  start_.push_back(0);
  for (Eigen::Index v = 0; v < rest_.rows(); ++v) {
    for (SparseMatrixd::InnerIterator it(head.skin_interpolation, v); it; ++it) {
      source_.push_back(static_cast<int>(it.col()));
      weight_.push_back(static_cast<float>(it.value()));
    }
    start_.push_back(static_cast<int>(source_.size()));
  }
}

MatrixX3d DrawnSkin::at(const MatrixX3d& volume) const {
  Eigen::Matrix4Xf moved = Eigen::Matrix4Xf::Zero(4, simulated_.size());
  for (Eigen::Index i = 0; i < simulated_.size(); ++i)
    moved.col(i).head<3>() = (volume.row(simulated_[i]) - simulated_rest_.row(i)).transpose().cast<float>();
  MatrixX3d drawn(rest_.rows(), 3);
  parallel_for(
      drawn.rows(),
      [&](std::ptrdiff_t v) {
        const auto row = static_cast<std::size_t>(v);
        Eigen::Vector4f sum = Eigen::Vector4f::Zero();
        for (auto k = static_cast<std::size_t>(start_[row]); k < static_cast<std::size_t>(start_[row + 1]); ++k)
          sum += weight_[k] * moved.col(source_[k]);
        drawn.row(v) = rest_.row(v) + sum.head<3>().transpose().cast<double>();
      },
      1024);
  return drawn;
}

}  // namespace phiz
